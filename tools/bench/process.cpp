#include "tools/bench/process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "kernels/core/error.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kGrace = 60;  // s

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

[[noreturn]] void become(const std::vector<std::string>& words, const fs::path& log) {
  if (!log.empty()) {
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file >= 0) dup2(file, 1), dup2(file, 2);
  }
  std::vector<char*> arguments;
  for (const std::string& w : words) arguments.push_back(const_cast<char*>(w.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

ProcessResult run_process(const std::vector<std::string>& words, double limit_s, const fs::path& log) {
  ProcessResult result;
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const pid_t child = fork();
  SHERD_CHECK(child >= 0, "no new process");
  if (child == 0) become(words, log);
  int status = 0;
  rusage usage{};
  for (;;) {
    const pid_t ended = wait4(child, &status, limit_s > 0 ? WNOHANG : 0, &usage);
    SHERD_CHECK(ended >= 0, "a process was lost");
    if (ended == child) break;
    if (!result.stopped && elapsed() > limit_s) kill(child, SIGINT), result.stopped = true;
    if (!result.hung && elapsed() > limit_s + kGrace) kill(child, SIGKILL), result.hung = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  result.wall_s = elapsed();
  result.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  return result;
}

std::string sherd_program(const std::string& given) {
  const fs::path program = given.empty() ? fs::read_symlink("/proc/self/exe").parent_path() / "sherd" : fs::path(given);
  if (access(program.c_str(), X_OK) != 0)
    throw InputError(fmt::format("{}: no program there; name the command with --program", program.string()));
  return program.string();
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "sherd-bench-XXXXXX").string();
  SHERD_CHECK(mkdtemp(name.data()) != nullptr, "no temporary folder");
  path = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  fs::remove_all(path, error);
}

}  // namespace sherd::bench
