// The `sherd` program run from a test in a folder of its own.
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace sherd::test {

namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string output, errors;
};

class Command : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / (std::string("sherd_command_") + test.name() + "_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  // Runs a shell script in the test's folder, with $SHERD the program.
  Outcome shell(const std::string& script) const {
    const std::string setting =
        "cd '" + folder_.string() + "' || exit 99; SHERD='" SHERD_COMMAND "'; exec >stdout 2>stderr; ";
    const int status = std::system((setting + script).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(folder_ / "stdout"), read(folder_ / "stderr")};
  }
  Outcome sherd(const std::string& arguments) const { return shell("\"$SHERD\" " + arguments); }
  void write_tetrahedron(const std::string& name, bool closed) const {
    write(name,
          std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n") + (closed ? "f 2 3 4\n" : ""));
  }

  fs::path folder_;
};

}  // namespace sherd::test
