// How much work each switch of [skip] left out, and how much was done.
#pragma once
#include "engine/scene/skip.h"

namespace sherd {

class SkipCounts {
 public:
  struct Count {
    std::size_t done = 0, skipped = 0;
  };
  const Count& operator[](Skip s) const { return counts_[static_cast<std::size_t>(s)]; }
  void done(Skip s, std::size_t n = 1) { counts_[static_cast<std::size_t>(s)].done += n; }
  void skipped(Skip s, std::size_t n = 1) { counts_[static_cast<std::size_t>(s)].skipped += n; }
  // One piece of work that was left out or not.
  void add(Skip s, bool left_out) { left_out ? skipped(s) : done(s); }
  SkipCounts& operator+=(const SkipCounts& b) {
    for (std::size_t i = 0; i < counts_.size(); ++i)
      counts_[i].done += b.counts_[i].done, counts_[i].skipped += b.counts_[i].skipped;
    return *this;
  }

 private:
  std::array<Count, kSkipSwitches.size()> counts_;
};

}  // namespace sherd
