// Adds the seconds of a scope to a counter.
#pragma once
#include <chrono>

#include "kernels/core/vec3.h"

namespace sherd {

class Stopwatch {
 public:
  explicit Stopwatch(Real& total) : total_(total), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() { total_ += std::chrono::duration<Real>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Real& total_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace sherd
