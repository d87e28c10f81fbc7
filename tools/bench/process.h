// Runs a program and waits for it.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace sherd::bench {

struct ProcessResult {
  int exit_code = 0;                             // minus the signal's number for a process that a signal ended
  bool stopped = false;                          // it was told to stop, for its time was over
  bool hung = false;                             // and did not within a minute
  double wall_s = 0, cpu_s = 0, peak_bytes = 0;  // as the operating system counts
};
// words[0]: the program. After `limit_s` (0: never) it gets SIGINT, a minute later SIGKILL. `log`: file for what it
// prints; empty: it prints to ours.
ProcessResult run_process(const std::vector<std::string>& words, double limit_s = 0,
                          const std::filesystem::path& log = {});

// The command `sherd`: `given`, or beside this program when that is empty. InputError when it is not there.
std::string sherd_program(const std::string& given);

// A folder in the temporary one, removed with the object.
struct TemporaryFolder {
  std::filesystem::path path;
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

}  // namespace sherd::bench
