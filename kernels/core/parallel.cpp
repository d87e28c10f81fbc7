#include "kernels/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <optional>

#include "kernels/core/thread_sanitizer.h"
#include "kernels/core/trace.h"

namespace sherd {
namespace {

// One digit of a radix sort. 1024 open cache lines fit a second-level cache.
constexpr int kDigitBits = 10;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits, kSortGrain = std::size_t{1} << 16;
using DigitPlaces = std::array<std::size_t, kDigits>;

std::size_t digit(std::uint64_t key, int shift) {
  return (key >> shift) & (kDigits - 1);
}

// Stable: chunks write behind one another within each digit.
void sort_by_digit(const std::vector<KeyedIndex>& from, std::vector<KeyedIndex>& to, int shift) {
  std::vector<DigitPlaces> places((from.size() + kSortGrain - 1) / kSortGrain);
  parallel_for_chunks(from.size(), kSortGrain, [&](std::size_t begin, std::size_t end) {
    DigitPlaces& count = places[begin / kSortGrain];
    count.fill(0);
    for (std::size_t i = begin; i < end; ++i) ++count[digit(from[i].key, shift)];
  });
  std::size_t next = 0;
  for (std::size_t d = 0; d < kDigits; ++d)
    for (DigitPlaces& chunk : places) {
      const std::size_t count = chunk[d];
      chunk[d] = next;
      next += count;
    }
  parallel_for_chunks(from.size(), kSortGrain, [&](std::size_t begin, std::size_t end) {
    DigitPlaces& place = places[begin / kSortGrain];
    for (std::size_t i = begin; i < end; ++i) to[place[digit(from[i].key, shift)]++] = from[i];
  });
}

}  // namespace

// Made in place: a copy of the control would end the limit with the original.
struct ThreadLimit::Impl {
  explicit Impl(std::size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
  const std::size_t count =
      threads > 0 ? static_cast<std::size_t>(threads) : static_cast<std::size_t>(tbb::info::default_concurrency());
  impl_ = std::make_unique<Impl>(count);
}
ThreadLimit::~ThreadLimit() = default;

void parallel_for_chunks(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  if (n == 0) return;
  const std::size_t chunks = (n + grain - 1) / grain;
  const auto run = [&](std::size_t c) { body(c * grain, (c + 1) * grain < n ? (c + 1) * grain : n); };
  if (chunks == 1) {
    run(0);
    return;
  }
  const char* const name = TraceScope::innermost();
  char handed_out, ended;
  happens_before(&handed_out);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunks, 1), [&](const tbb::blocked_range<std::size_t>& r) {
    happens_after(&handed_out);
    std::optional<TraceScope> scope;
    if (name && !TraceScope::innermost()) scope.emplace(name);
    for (std::size_t c = r.begin(); c != r.end(); ++c) run(c);
    happens_before(&ended);
  });
  happens_after(&ended);
}

void parallel_sort(std::vector<KeyedIndex>& items) {
  if (items.size() < kDigits) {
    std::ranges::stable_sort(items, {}, &KeyedIndex::key);
    return;
  }
  std::uint64_t varying = 0;
  for (const KeyedIndex& item : items) varying |= item.key ^ items.front().key;
  std::vector<KeyedIndex> other(items.size());
  for (int shift = 0; shift < 64; shift += kDigitBits)
    if (digit(varying, shift) != 0) {
      sort_by_digit(items, other, shift);
      items.swap(other);
    }
}

}  // namespace sherd
