// Files appear whole or not at all, and a failure says which and what to do.
#include "kernels/core/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "kernels/core/error.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("sherd_files_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  template <class F>
  static std::string refusal(const F& call) {
    try {
      call();
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }
  static void expect_part(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  }
  std::size_t count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

TEST_F(Files, ReplaceAFileAndLeaveNothingElse) {
  const std::string large(300'000, 'x');
  for (const Durability d : {Durability::kSoon, Durability::kNow}) {
    replace_file(folder_ / "a", "first", d);
    replace_file(folder_ / "a", large, d);
    EXPECT_EQ(read_bytes(folder_ / "a"), large);
    EXPECT_EQ(count(), 1u);
  }
  const std::array files{folder_ / "a", folder_};
  flush_to_disk(files);
}

TEST_F(Files, AFailedWriteKeepsTheOldFileAndNamesFileReasonAndRemedy) {
  replace_file(folder_ / "a", "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1000;
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string text = refusal([&] { replace_file(folder_ / "a", std::string(5000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  expect_part(text, (folder_ / "a").string() + ": cannot be written (File too large); raise the limit");
  EXPECT_EQ(read_bytes(folder_ / "a"), "old");
  EXPECT_EQ(count(), 1u);
}

TEST_F(Files, AFullDiskIsNamed) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full here";
  fs::create_symlink("/dev/full", folder_ / "a.part");
  expect_part(refusal([&] { replace_file(folder_ / "a", "x"); }),
              (folder_ / "a").string() + ": cannot be written (No space left on device); free some space");
  EXPECT_EQ(count(), 0u);
}

TEST_F(Files, AFileWhereAFolderShouldBeIsNamed) {
  replace_file(folder_ / "a", "mine");
  expect_part(refusal([&] { make_folder(folder_ / "a", "think again"); }), (folder_ / "a").string() + ": cannot write");
  expect_part(refusal([&] { make_folder(folder_ / "a" / "b", "think again"); }), "think again");
  expect_part(refusal([&] { replace_file(folder_ / "a" / "b", "x"); }), "choose a writable folder");
  expect_part(refusal([&] { read_bytes(folder_ / "none"); }),
              (folder_ / "none").string() + ": cannot be read (No such");
  EXPECT_EQ(read_bytes(folder_ / "a"), "mine");
}

TEST_F(Files, AFolderInTheWayOfAFileStays) {
  fs::create_directories(folder_ / "a" / "b");
  expect_part(refusal([&] { replace_file(folder_ / "a", "x"); }), (folder_ / "a").string() + ": cannot be written");
  EXPECT_TRUE(fs::exists(folder_ / "a" / "b"));
  EXPECT_EQ(count(), 1u);
}

}  // namespace
}  // namespace sherd
