// Damaged files: load_mesh() and repair_mesh() either give a valid solid or throw InputError, whatever the bytes are.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/mesh/load.h"
#include "engine/mesh/repair.h"
#include "engine/mesh/shapes.h"
#include "engine/mesh/validate.h"
#include "engine/mesh/write.h"
#include "kernels/core/error.h"
#include "kernels/core/random.h"

namespace sherd {
namespace {

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

// Changes, removes or repeats a few bytes.
std::string damaged(std::string text, Random& random) {
  const int wounds = 1 + static_cast<int>(random.next() % 6);
  for (int i = 0; i < wounds && !text.empty(); ++i) {
    const std::size_t at = random.next() % text.size(), length = 1 + random.next() % 8;
    switch (random.next() % 4) {
      case 0:
        text[at] = static_cast<char>(random.next() & 0xFF);
        break;
      case 1:
        text[at] = static_cast<char>("0123456789 -.e\n"[random.next() % 15]);
        break;
      case 2:
        text.erase(at, length);
        break;
      default:
        text.insert(at, text.substr(random.next() % text.size(), length));
        break;
    }
  }
  return text;
}

struct Outcome {
  int valid = 0, refused = 0;
};

Outcome try_damaged(const std::string& file, int runs, std::uint64_t seed) {
  const std::string whole = content(file);
  Random random(seed);
  Outcome outcome;
  for (int run = 0; run < runs; ++run) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << damaged(whole, random);
    try {
      LoadLog log;
      SurfaceMesh mesh = load_mesh(file, {}, log);
      repair_mesh(mesh, {.name = file, .max_hole_diameter = 10}, log.messages);
      EXPECT_TRUE(is_valid(report_mesh(mesh))) << "run " << run;
      ++outcome.valid;
    } catch (const InputError& e) {
      EXPECT_FALSE(std::string(e.what()).empty());
      ++outcome.refused;
    }
  }
  return outcome;
}

class FuzzLoad : public ::testing::Test {
 protected:
  FuzzLoad() : folder_(std::filesystem::path(::testing::TempDir()) / ("sherd_fuzz_" + std::string(name()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~FuzzLoad() override { std::filesystem::remove_all(folder_); }
  static const char* name() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }
  std::string path(const std::string& file) const { return (folder_ / file).string(); }
  std::filesystem::path folder_;
};

// Both outcomes must occur, or the damage would be too weak or too strong to test anything.
TEST_F(FuzzLoad, DamagedPlyIsRepairedOrRefused) {
  write_ply(make_sphere(1, 0.6), path("a.ply"));
  const Outcome o = try_damaged(path("a.ply"), 1000, 1);
  EXPECT_GT(o.valid, 30);
  EXPECT_GT(o.refused, 30);
}

TEST_F(FuzzLoad, DamagedDoublePlyIsRepairedOrRefused) {
  write_ply(make_torus(1, 0.4, 0.5), path("a.ply"), PlyPrecision::kDouble);
  const Outcome o = try_damaged(path("a.ply"), 1000, 2);
  EXPECT_GT(o.valid, 30);
  EXPECT_GT(o.refused, 30);
}

TEST_F(FuzzLoad, DamagedObjIsRepairedOrRefused) {
  write_obj(make_hollow_sphere(1, 0.5, 0.6), path("a.obj"));
  const Outcome o = try_damaged(path("a.obj"), 1000, 3);
  EXPECT_GT(o.valid, 30);
  EXPECT_GT(o.refused, 30);
}

}  // namespace
}  // namespace sherd
