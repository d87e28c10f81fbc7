// Deterministic parallel loops. oneTBB is included by parallel.cpp alone.
// Every loop body owns its outputs; sums are taken over fixed chunks in order, so results have the same bits for any
// number of threads.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace sherd {

// Limits the threads of all parallel loops while alive; threads >= 1, 0 means all processors.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// body(begin, end) over [0, n) in chunks of at most `grain`; the chunk borders do not depend on the thread count.
void parallel_for_chunks(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

template <class F>
void parallel_for(std::size_t n, std::size_t grain, const F& body) {
  parallel_for_chunks(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

// Sum of value(i) over [0, n): chunk sums in parallel, then added in chunk order.
template <class T, class F>
T parallel_sum(std::size_t n, std::size_t grain, const F& value) {
  std::vector<T> partial((n + grain - 1) / grain, T{});
  parallel_for_chunks(n, grain, [&](std::size_t begin, std::size_t end) {
    T sum{};
    for (std::size_t i = begin; i < end; ++i) sum += value(i);
    partial[begin / grain] = sum;
  });
  T total{};
  for (const T& p : partial) total += p;
  return total;
}

struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

// Sorts by key, equal keys in the order given, so the result is unique. Linear in the number of items; takes as much
// memory again while it runs.
void parallel_sort(std::vector<KeyedIndex>& items);

}  // namespace sherd
