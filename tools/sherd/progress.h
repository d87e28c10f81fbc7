// How far a run is, for a person: one line rewritten in place on a terminal, plain lines otherwise.
#pragma once
#include <chrono>
#include <string>

#include "kernels/core/vec3.h"

namespace sherd {

class Progress {
 public:
  // `duration`: simulated seconds of the whole run. Quiet prints nothing at all.
  Progress(Real duration, bool quiet);
  ~Progress();  // ends the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Of a run that goes on: what lies behind took no time here.
  void begin_at(Real time) { begun_ = time; }
  // Call after every step; prints on a terminal at most ten times a second, elsewhere at every tenth of the run.
  void update(Real time, std::size_t bodies, std::size_t frames);
  // A line of its own.
  void note(const std::string& text);
  // The same on stderr, for what makes the results doubtful.
  void warn(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  void clear_line();

  Real duration_, begun_ = 0;
  bool quiet_, terminal_;
  bool line_open_ = false;
  int tenths_ = 0;  // last tenth of the run that was printed
  Clock::time_point start_, last_;
};

// "12.34 s", "2:05 min", "1:02:09 h".
std::string duration_text(double seconds);

}  // namespace sherd
