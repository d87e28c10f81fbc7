// State to bytes and back, by one walk for both directions. Numbers, enumerations, strings, containers, shared objects
// and plain records of these need no code: a new member of a record is kept because it is there. A type that needs its
// own words declares `void describe(Archive&, T&)` in namespace sherd, before its first use in an archive.
//
// Bytes are those of this machine and this build; whoever stores them says so in a header. Objects held by several
// shared pointers are stored once and shared again after reading.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <typeindex>
#include <utility>
#include <vector>

#include "kernels/core/column.h"
#include "kernels/core/fields.h"

namespace sherd {

// The bytes do not fit what is read from them: cut short, too long, or of another layout.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Archive {
 public:
  Archive() = default;                                                          // writes
  explicit Archive(std::string_view bytes) : source_(bytes), reading_(true) {}  // reads; `bytes` outlive it

  bool reading() const { return reading_; }
  // Copies `size` bytes to the archive or from it. Throws ArchiveError when they are not there.
  void raw(void* data, std::size_t size);
  // A number of elements of at least `least` bytes each, which must still be there when reading.
  std::size_t count(std::size_t written, std::size_t least);
  // When writing: everything written.
  std::string take() { return std::move(written_); }
  // When reading: throws ArchiveError when bytes are left.
  void finish() const;

  // The object behind a shared pointer: `body` describes it when it is met for the first time.
  template <class T, class Body>
  void shared(std::shared_ptr<T>& pointer, const Body& body);

 private:
  std::string written_;
  std::string_view source_;
  bool reading_ = false;
  std::map<const void*, std::uint64_t> known_;                                // when writing
  std::vector<std::pair<std::type_index, std::shared_ptr<const void>>> met_;  // when reading
};

namespace archived {

template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t n>
inline constexpr bool is_array<std::array<T, n>> = true;

// Without padding, pointers or booleans: bytes are values.
template <class T>
inline constexpr bool is_bytes = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;
template <class T, std::size_t n>
inline constexpr bool is_bytes<std::array<T, n>> = is_bytes<T>;

}  // namespace archived

template <class T>
void archive(Archive& a, T& value);

template <class T>
void describe(Archive& a, Mat3T<T>& v) {
  a.raw(v.m, sizeof(v.m));
}
inline void describe(Archive& a, bool& v) {
  std::uint8_t byte = v ? 1 : 0;
  a.raw(&byte, 1);
  v = byte != 0;
}
inline void describe(Archive& a, std::string& v) {
  v.resize(a.count(v.size(), 1));
  a.raw(v.data(), v.size());
}
inline void describe(Archive& a, std::vector<bool>& v) {
  v.resize(a.count(v.size(), 1));
  for (std::size_t i = 0; i < v.size(); ++i) {
    bool flag = v[i];
    describe(a, flag);
    v[i] = flag;
  }
}
template <class T>
void describe(Archive& a, std::vector<T>& v) {
  v.resize(a.count(v.size(), archived::is_bytes<T> ? sizeof(T) : 1));
  if constexpr (archived::is_bytes<T>)
    a.raw(v.data(), v.size() * sizeof(T));
  else
    for (T& element : v) archive(a, element);
}
template <class T, std::size_t n>
void describe(Archive& a, std::array<T, n>& v) {
  for (T& element : v) archive(a, element);
}
template <class A, class B>
void describe(Archive& a, std::pair<A, B>& v) {
  archive(a, v.first), archive(a, v.second);
}
template <class T>
void describe(Archive& a, std::optional<T>& v) {
  bool there = v.has_value();
  describe(a, there);
  if (a.reading()) v = there ? std::optional<T>(T{}) : std::nullopt;
  if (v) archive(a, *v);
}
template <class K, class V>
void describe(Archive& a, std::map<K, V>& v) {
  const std::size_t n = a.count(v.size(), 1);
  if (!a.reading()) {
    for (auto& [key, value] : v) {
      K copy = key;
      archive(a, copy), archive(a, value);
    }
    return;
  }
  v.clear();
  for (std::size_t i = 0; i < n; ++i) {
    K key{};
    archive(a, key);
    archive(a, v[key]);
  }
}
inline void describe(Archive& a, Vec3Column& v) {
  auto& [x, y, z] = v;
  archive(a, x), archive(a, y), archive(a, z);
}
template <class T>
void describe(Archive& a, std::shared_ptr<T>& v) {
  a.shared(v, [&](std::shared_ptr<std::remove_const_t<T>>& object) {
    if (!object) object = std::make_shared<std::remove_const_t<T>>();
    archive(a, *object);
  });
}

template <class T>
void archive(Archive& a, T& value) {
  static_assert(!std::is_const_v<T>);
  if constexpr (requires { describe(a, value); }) {
    describe(a, value);
  } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    a.raw(&value, sizeof(T));
  } else {
    static_assert(std::is_aggregate_v<T>, "this type needs a describe() of its own");
    visit_members(value, [&](auto&... member) { (archive(a, member), ...); });
  }
}

template <class T, class Body>
void Archive::shared(std::shared_ptr<T>& pointer, const Body& body) {
  using Object = std::remove_const_t<T>;
  constexpr std::uint64_t kNull = 0;  // else one more than the place in the order of first meetings
  std::uint64_t place = kNull;
  bool fresh = false;
  if (!reading_ && pointer) {
    const auto [at, added] = known_.try_emplace(pointer.get(), known_.size() + 1);
    place = at->second, fresh = added;
  }
  raw(&place, sizeof(place));
  if (!reading_) {
    auto object = std::const_pointer_cast<Object>(pointer);  // the walk takes what it writes by reference, too
    if (fresh) body(object);
    return;
  }
  if (place > met_.size() + 1) throw ArchiveError("a reference leads nowhere");
  pointer = nullptr;
  if (place == kNull) return;
  if (place == met_.size() + 1) {
    met_.emplace_back(typeid(Object), nullptr);
    std::shared_ptr<Object> object;
    body(object);
    met_[place - 1].second = object;
    pointer = std::move(object);
    return;
  }
  const auto& [type, object] = met_[place - 1];
  if (type != typeid(Object) || !object) throw ArchiveError("a reference leads to something else");
  pointer = std::const_pointer_cast<T>(std::static_pointer_cast<const T>(object));
}

// FNV-1a: any single wrong byte changes it for certain, others with odds of 2^64 to one. Not against malice.
constexpr std::uint64_t kDigestStart = 0xcbf29ce484222325u;
std::uint64_t digest(std::string_view bytes, std::uint64_t start = kDigestStart);

}  // namespace sherd
