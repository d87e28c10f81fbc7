// sherd-bench pairs: how many pairs of points a second the sums over pairs take, on one thread.
#pragma once
#include <cstddef>
#include <string>

namespace sherd::bench {

struct PairsOptions {
  std::size_t targets = 128, sources = 128;  // of a block; targets are rounded up to a multiple of the padding
  double seconds = 0.03;                     // CPU time a measurement, of which the best of `repeats` counts
  int repeats = 5;
  std::string json;  // file; empty: none
};
// Prints the table; returns the exit code.
int run_pairs(const PairsOptions& options);

}  // namespace sherd::bench
