// The bytes that libFuzzer tries, as a file: the readers take names.
#pragma once
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace sherd {

// One file a process, in memory where the system has such a folder. It is left to the next run's bytes.
inline std::string fuzzed_file(const std::string& ending, const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder =
      std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path();
  static const std::string name = (folder / ("sherd_fuzz_" + std::to_string(getpid()) + "." + ending)).string();
  std::FILE* file = std::fopen(name.c_str(), "wb");
  if (file == nullptr || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0) {
    std::perror(name.c_str());
    std::abort();
  }
  return name;
}

// What libFuzzer reports as a crash.
inline void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "broken law: %s\n", law);
  std::abort();
}

}  // namespace sherd
