// A map between 32-bit numbers that costs what is in it, not what it could hold: a cut that touches a hundred faces of
// a million must not clear a column of a million. It has no iteration, so nothing depends on its inner order.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

namespace sherd {

class SparseMap {
 public:
  static constexpr std::uint32_t kAbsent = 0xFFFFFFFFu;  // neither a key nor a value

  SparseMap() : slots_(16, {kAbsent, kAbsent}) {}

  std::uint32_t operator[](std::uint32_t key) const { return slots_[place(key)].second; }
  bool contains(std::uint32_t key) const { return (*this)[key] != kAbsent; }
  std::size_t size() const { return size_; }
  // False, and nothing changed, when the key is there already.
  bool insert(std::uint32_t key, std::uint32_t value) {
    auto& slot = slots_[place(key)];
    if (slot.first == key) return false;
    slot = {key, value};
    if (2 * ++size_ > slots_.size()) grow();
    return true;
  }
  void set(std::uint32_t key, std::uint32_t value) {
    if (!insert(key, value)) slots_[place(key)].second = value;
  }

 private:
  std::size_t place(std::uint32_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = (key * 0x9E3779B97F4A7C15ull >> 32) & mask;
    while (slots_[i].first != key && slots_[i].first != kAbsent) i = (i + 1) & mask;
    return i;
  }
  void grow() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> old(2 * slots_.size(), {kAbsent, kAbsent});
    old.swap(slots_);
    for (const auto& slot : old)
      if (slot.first != kAbsent) slots_[place(slot.first)] = slot;
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>> slots_;  // a power of two, at most half full
  std::size_t size_ = 0;
};

}  // namespace sherd
