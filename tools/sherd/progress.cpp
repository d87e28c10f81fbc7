#include "tools/sherd/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sherd {

std::string duration_text(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const long whole = std::lround(seconds);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02} h", whole / 3600, whole / 60 % 60, whole % 60);
}

Progress::Progress(Real duration, bool quiet)
    : duration_(duration), quiet_(quiet), terminal_(isatty(STDOUT_FILENO) == 1), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
  if (line_open_) std::printf("\n");
  std::fflush(stdout);
}

void Progress::clear_line() {
  if (line_open_) std::printf("\r\033[K");
  line_open_ = false;
}

void Progress::update(Real time, std::size_t bodies, std::size_t frames) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  const Real part = std::clamp(time / duration_, 0.0, 1.0);
  const int tenths = static_cast<int>(std::floor(10 * part));
  const bool due = terminal_ ? now - last_ > std::chrono::milliseconds(100) : tenths > tenths_;
  if (!due) return;
  last_ = now;
  tenths_ = tenths;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  // A few percent of the run must lie behind before the rest can be estimated from it.
  const Real done = part - begun_ / duration_;
  const std::string left = done > 0.02 ? "about " + duration_text(elapsed * (1 - part) / done) + " left" : "";
  clear_line();
  std::printf("%3.0f %%  %.3f of %.3f s, %zu %s, %zu frames, %s%s%s%s", 100 * part, time, duration_, bodies,
              bodies == 1 ? "body" : "bodies", frames, duration_text(elapsed).c_str(), left.empty() ? "" : ", ",
              left.c_str(), terminal_ ? "" : "\n");
  line_open_ = terminal_;
  std::fflush(stdout);
}

void Progress::note(const std::string& text) {
  if (quiet_) return;
  clear_line();
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
}

void Progress::warn(const std::string& text) {
  if (quiet_) return;
  clear_line();
  std::fflush(stdout);
  std::fprintf(stderr, "warning: %s\n", text.c_str());
}

}  // namespace sherd
