// Processor time of the calling thread: what else the machine does, and stages that other threads help with, do not
// count. Campaigns that are to measure time run on one thread.
#pragma once
#include <time.h>

#include "kernels/core/vec3.h"

namespace sherd::campaign {

inline Real cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<Real>(t.tv_sec) + 1e-9 * static_cast<Real>(t.tv_nsec);
}

// Adds the time of a scope to a counter.
class CpuStopwatch {
 public:
  explicit CpuStopwatch(Real& total) : total_(total), start_(cpu_seconds()) {}
  ~CpuStopwatch() { total_ += cpu_seconds() - start_; }
  CpuStopwatch(const CpuStopwatch&) = delete;
  CpuStopwatch& operator=(const CpuStopwatch&) = delete;

 private:
  Real& total_;
  Real start_;
};

}  // namespace sherd::campaign
