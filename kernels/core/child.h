// Work in a process of its own: what it breaks stays there.
#pragma once
#include <functional>
#include <string>

namespace sherd {

struct ChildResult {
  std::string bytes;  // what the work returned
  std::string died;   // how the child ended without returning: "signal 11 (Segmentation fault)"; empty when it returned
};

// For libraries that damaged input can crash: `work` runs in a copy of this process (fork), which sees all memory as it
// is now and changes none of ours, with no more than `cpu_seconds` of processor time, and silent on standard error.
// `work` must not need other threads of this process, for they are not in the copy. An exception that leaves `work`
// is a way to die. Throws std::runtime_error when there can be no child.
ChildResult run_in_child(const std::function<std::string()>& work, unsigned cpu_seconds);

}  // namespace sherd
