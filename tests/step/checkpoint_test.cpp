// Checkpoint files: the last whole one is found, damage is seen, what differs is named.
#include "engine/step/checkpoint.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "kernels/core/error.h"
#include "kernels/core/file.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

class Checkpoints : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("sherd_checkpoints_" + std::to_string(getpid()));
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static Checkpoint checkpoint(std::size_t step) {
    return {{"program 1", 7, "--wireframe"}, step, 0.001 * static_cast<Real>(step), std::string(300, 's'), "writer"};
  }
  fs::path file(std::size_t step) const { return folder_ / "checkpoint" / fmt::format("step_{:08}.sherd", step); }
  std::string refusal() const {
    try {
      find_checkpoint(folder_);
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }
  fs::path folder_;
};

TEST_F(Checkpoints, TheLatestIsFoundAndTheLastTwoAreKept) {
  EXPECT_FALSE(find_checkpoint(folder_).checkpoint);
  for (const std::size_t step : {2, 4, 6, 100}) write_checkpoint(folder_, checkpoint(step));
  const FoundCheckpoint found = find_checkpoint(folder_);
  ASSERT_TRUE(found.checkpoint);
  EXPECT_TRUE(found.damaged.empty());
  EXPECT_EQ(found.checkpoint->step, 100u);
  EXPECT_EQ(found.checkpoint->time, 0.1);
  EXPECT_EQ(found.checkpoint->simulation, std::string(300, 's'));
  EXPECT_EQ(found.checkpoint->writer, "writer");
  require_same_run(folder_, found.checkpoint->identity, checkpoint(0).identity);
  EXPECT_TRUE(fs::exists(file(6)) && fs::exists(file(100)));
  EXPECT_FALSE(fs::exists(file(4)));
  remove_checkpoints(folder_);
  EXPECT_FALSE(fs::exists(folder_ / "checkpoint"));
}

TEST_F(Checkpoints, ADamagedOneIsNamedAndTheOneBeforeServes) {
  write_checkpoint(folder_, checkpoint(2));
  write_checkpoint(folder_, checkpoint(4));
  const std::string whole = read_bytes(file(4));
  std::vector<std::string> damaged{"",
                                   whole.substr(0, 7),
                                   whole.substr(0, whole.size() / 2),
                                   whole + "x",
                                   whole.substr(0, whole.size() - 1),
                                   std::string(whole.size(), '\0')};
  for (std::size_t i = 16; i < whole.size(); i += 13) {  // the first 16 bytes say what the others are
    damaged.push_back(whole);
    damaged.back()[i] = static_cast<char>(damaged.back()[i] ^ 16);
  }
  for (const std::string& bytes : damaged) {
    replace_file(file(4), bytes);
    const FoundCheckpoint found = find_checkpoint(folder_);
    ASSERT_TRUE(found.checkpoint);
    EXPECT_EQ(found.checkpoint->step, 2u);
    ASSERT_EQ(found.damaged.size(), 1u);
    EXPECT_EQ(found.damaged[0].find(file(4).string() + ": damaged"), 0u) << found.damaged[0];
  }
  replace_file(file(2), "x");
  EXPECT_NE(refusal().find("no whole checkpoint is left; start anew"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find(file(2).string()), std::string::npos) << refusal();
}

TEST_F(Checkpoints, AHalfWrittenOneIsNotLookedAt) {
  write_checkpoint(folder_, checkpoint(2));
  replace_file(folder_ / "other", "x");
  fs::rename(folder_ / "other", file(4).string() + ".part");
  EXPECT_EQ(find_checkpoint(folder_).checkpoint->step, 2u);
  remove_checkpoints(folder_);
  EXPECT_FALSE(fs::exists(folder_ / "checkpoint"));
}

TEST_F(Checkpoints, OneOfAnotherFormatOrByteOrderIsRefusedNotPassedOver) {
  write_checkpoint(folder_, checkpoint(2));
  write_checkpoint(folder_, checkpoint(4));
  const std::string whole = read_bytes(file(4));
  std::string other = whole;
  other[12] = 99;
  replace_file(file(4), other);
  EXPECT_NE(refusal().find("has format 99"), std::string::npos) << refusal();
  other = whole;
  std::reverse(other.begin() + 8, other.begin() + 12);
  replace_file(file(4), other);
  EXPECT_NE(refusal().find("another byte order"), std::string::npos) << refusal();
}

TEST_F(Checkpoints, WhatDiffersIsNamedWithTheRemedy) {
  const RunIdentity now = checkpoint(0).identity;
  const auto refused = [&](const RunIdentity& written) -> std::string {
    try {
      require_same_run(folder_, written, now);
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_EQ(refused(now), "");
  EXPECT_NE(refused({"program 2", 7, "--wireframe"}).find("written by program 2, but this is program 1"),
            std::string::npos);
  EXPECT_NE(refused({"program 1", 8, "--wireframe"}).find("the scene, or a mesh file it reads, has changed"),
            std::string::npos);
  EXPECT_NE(refused({"program 1", 7, ""}).find("began with the options '', not '--wireframe'"), std::string::npos);
}

TEST_F(Checkpoints, OneThatCannotBeWrittenLeavesThoseOfBefore) {
  write_checkpoint(folder_, checkpoint(2));
  const std::string before = read_bytes(file(2));
  fs::create_directories(file(4).string() + ".part");  // in the way
  try {
    write_checkpoint(folder_, checkpoint(4));
    ADD_FAILURE() << "written";
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()).find(file(4).string() + ": cannot be written"), 0u) << e.what();
  }
  EXPECT_EQ(read_bytes(file(2)), before);
  EXPECT_EQ(find_checkpoint(folder_).checkpoint->step, 2u);
}

}  // namespace
}  // namespace sherd
