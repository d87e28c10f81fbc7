#include "kernels/core/child.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <stdexcept>

namespace sherd {
namespace {

TEST(Child, ReturnsTheBytesOfItsWork) {
  // More than a pipe holds at a time.
  std::string bytes(1'000'000, 'a');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7 % 251);
  const ChildResult r = run_in_child([&] { return bytes; }, 60);
  EXPECT_EQ(r.died, "");
  EXPECT_EQ(r.bytes, bytes);
}

TEST(Child, ChangesNothingOfItsParent) {
  int value = 1;
  const ChildResult r = run_in_child(
      [&] {
        value = 2;
        return std::to_string(value);
      },
      60);
  EXPECT_EQ(r.bytes, "2");
  EXPECT_EQ(value, 1);
}

TEST(Child, ItsCrashIsAResult) {
  EXPECT_NE(run_in_child([]() -> std::string { std::abort(); }, 60).died.find("signal 6"), std::string::npos);
  EXPECT_NE(run_in_child(
                [] {
                  std::raise(SIGSEGV);
                  return std::string();
                },
                60)
                .died.find("signal 11"),
            std::string::npos);
}

TEST(Child, ItsExceptionIsAResult) {
  const ChildResult r = run_in_child([]() -> std::string { throw std::runtime_error("no"); }, 60);
  EXPECT_EQ(r.died, "an exception");
  EXPECT_EQ(r.bytes, "");
}

TEST(Child, EndlessWorkIsStopped) {
  const ChildResult r = run_in_child(
      [] {
        for (std::atomic<unsigned> n = 0;; ++n) {
        }
        return std::string();
      },
      1);
  EXPECT_EQ(r.died, "too much time or memory");
}

TEST(Child, ACrashIsSeenWhereTheParentIgnoresItsChildren) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  const ChildResult crashed = run_in_child([]() -> std::string { std::abort(); }, 60),
                    whole = run_in_child([] { return std::string("bytes"); }, 60);
  std::signal(SIGCHLD, before);
  EXPECT_NE(crashed.died, "");
  EXPECT_EQ(whole.died, "");
  EXPECT_EQ(whole.bytes, "bytes");
}

}  // namespace
}  // namespace sherd
