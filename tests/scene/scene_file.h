// A scene file in a temporary folder of its own, removed at the end.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "engine/scene/scene.h"
#include "kernels/core/error.h"

namespace sherd {

class SceneFile : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    // The process number keeps two runs of the same test apart.
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("sherd_") + test.test_suite_name() + "_" + test.name() + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Scene load(const std::string& text) const { return load_scene(write("scene.toml", text)); }
  // The error's text with the folder taken out: "scene.toml:3:11: ...". Empty when the scene is accepted.
  std::string problem(const std::string& text) const { return problem_of(write("scene.toml", text)); }
  std::string problem_of(const std::filesystem::path& file) const {
    try {
      load_scene(file);
    } catch (const InputError& error) {
      std::string message = error.what();
      const std::string prefix = folder_.string() + "/";
      for (std::size_t at; (at = message.find(prefix)) != std::string::npos;) message.erase(at, prefix.size());
      return message;
    }
    return {};
  }

  std::filesystem::path folder_;
};

// The smallest scene; what a test adds to it starts on line 4.
inline const std::string kBall = "[[body]]\nname = \"ball\"\nshape = {kind = \"sphere\", radius = 0.1}\n";

}  // namespace sherd
