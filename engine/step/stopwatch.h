// Adds the seconds of a scope to a counter, and shows it in the trace.
#pragma once
#include <chrono>

#include "kernels/core/trace.h"
#include "kernels/core/vec3.h"

namespace sherd {

class Stopwatch {
 public:
  Stopwatch(Real& total, const char* name) : total_(total), start_(std::chrono::steady_clock::now()), scope_(name) {}
  // `detail()` gives the text beside the name in the trace.
  template <class Detail>
  Stopwatch(Real& total, const char* name, const Detail& detail)
      : total_(total), start_(std::chrono::steady_clock::now()), scope_(name, detail) {}
  ~Stopwatch() { total_ += std::chrono::duration<Real>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Real& total_;
  std::chrono::steady_clock::time_point start_;
  TraceScope scope_;
};

}  // namespace sherd
