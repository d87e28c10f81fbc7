// How much work each switch of [skip] left out, and how much was done.
#pragma once
#include "engine/scene/skip.h"

namespace sherd {

struct SkipCounts {
  struct Count {
    std::size_t done = 0, skipped = 0;
  };
  const Count& operator[](Skip s) const { return counts[static_cast<std::size_t>(s)]; }
  void done(Skip s, std::size_t n = 1) { counts[static_cast<std::size_t>(s)].done += n; }
  void skipped(Skip s, std::size_t n = 1) { counts[static_cast<std::size_t>(s)].skipped += n; }
  // One piece of work that was left out or not.
  void add(Skip s, bool left_out) { left_out ? skipped(s) : done(s); }
  SkipCounts& operator+=(const SkipCounts& b) {
    for (std::size_t i = 0; i < counts.size(); ++i)
      counts[i].done += b.counts[i].done, counts[i].skipped += b.counts[i].skipped;
    return *this;
  }

  std::array<Count, kSkipSwitches.size()> counts;
};

}  // namespace sherd
