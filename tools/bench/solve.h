// Whole elastostatic solves of a body with an exact solution, from thousands of triangles to a million.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace sherd::bench {

struct SolveBenchOptions {
  std::vector<std::size_t> triangles{5000, 20000, 100000};
  std::vector<std::string> operators{"fast"};  // auto, dense, fast
  double tolerance = 1e-4;                     // of the linear solver
  double gigabytes = 16;                       // largest operator
  std::string json;
};
// Prints a table; 0, or 1 when a solve failed.
int run_solve(const SolveBenchOptions& options);

}  // namespace sherd::bench
