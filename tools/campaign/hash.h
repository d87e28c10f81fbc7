// Fingerprints of results: equal bits, equal hash.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/core/column.h"

namespace sherd::campaign {

// FNV-1a over bytes (Fowler, Noll and Vo).
class Hash {
 public:
  void add_bytes(const void* data, std::size_t n) {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < n; ++i) value_ = (value_ ^ byte[i]) * 0x100000001B3ull;
  }
  template <class T>
  void add(const std::vector<T>& v) {
    add_number(v.size());
    if (!v.empty()) add_bytes(v.data(), v.size() * sizeof(T));
  }
  void add(const Vec3Column& c) { add(c.x), add(c.y), add(c.z); }
  void add_number(std::uint64_t n) { add_bytes(&n, sizeof n); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325ull;
};

}  // namespace sherd::campaign
