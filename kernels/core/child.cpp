#include "kernels/core/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace sherd {
namespace {

constexpr int kThrew = 70;
constexpr char kWhole = '.';  // after the bytes: a parent that ignores SIGCHLD learns nothing from waitpid()

void be_quiet_and_brief(unsigned cpu_seconds) {
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
  const rlimit no_core{0, 0}, time{cpu_seconds, cpu_seconds + 1};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &time);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM}) std::signal(signal, SIG_DFL);
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C is the parent's to answer
}

bool write_all(int to, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t n = write(to, bytes.data() + at, bytes.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += static_cast<std::size_t>(n);
  }
  return true;
}

// Ends the process without destructors or flushes: buffers and threads are the parent's.
[[noreturn]] void be_child(const std::function<std::string()>& work, unsigned cpu_seconds, int to) {
  be_quiet_and_brief(cpu_seconds);
  int code = kThrew;
  try {
    code = write_all(to, work() + kWhole) ? 0 : 1;
  } catch (...) {
    code = kThrew;
  }
  _exit(code);
}

std::string read_all(int from) {
  std::string bytes;
  std::array<char, 1 << 16> part;
  for (;;) {
    const ssize_t n = read(from, part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return bytes;
    bytes.append(part.data(), static_cast<std::size_t>(n));
  }
}

std::string how_it_died(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return signal == SIGXCPU || signal == SIGKILL ? "too much time or memory"
                                                  : fmt::format("signal {} ({})", signal, strsignal(signal));
  }
  if (WEXITSTATUS(status) == kThrew) return "an exception";
  return WEXITSTATUS(status) == 0 ? "" : fmt::format("exit code {}", WEXITSTATUS(status));
}

}  // namespace

ChildResult run_in_child(const std::function<std::string()>& work, unsigned cpu_seconds) {
  std::array<int, 2> pipe_ends;
  if (pipe(pipe_ends.data()) != 0) throw std::runtime_error(fmt::format("no pipe: {}", std::strerror(errno)));
  const pid_t child = fork();
  if (child == 0) {
    close(pipe_ends[0]);
    be_child(work, cpu_seconds, pipe_ends[1]);
  }
  close(pipe_ends[1]);
  if (child < 0) {
    close(pipe_ends[0]);
    throw std::runtime_error(fmt::format("no process: {}", std::strerror(errno)));
  }
  ChildResult result{read_all(pipe_ends[0]), {}};
  close(pipe_ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.died = how_it_died(status);
  const bool whole = !result.bytes.empty() && result.bytes.back() == kWhole;
  if (whole) result.bytes.pop_back();
  if (result.died.empty() && !whole) result.died = "an unknown way";
  return result;
}

}  // namespace sherd
