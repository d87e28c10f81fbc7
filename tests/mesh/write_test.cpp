#include "engine/mesh/write.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/mesh/load.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

class Write : public ::testing::Test {
 protected:
  Write() : folder_(std::filesystem::path(::testing::TempDir()) / ("sherd_write_" + std::string(name()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Write() override { std::filesystem::remove_all(folder_); }
  static const char* name() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }
  std::string path(const std::string& file) const { return (folder_ / file).string(); }
  static std::string content(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }
  std::filesystem::path folder_;
};

void expect_same_geometry(const SurfaceMesh& a, const SurfaceMesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST_F(Write, DoublePlyAndObjReadBackToTheSameBits) {
  const SurfaceMesh mesh = make_sphere(1.0 / 3, 0.1);
  write_ply(mesh, path("a.ply"), PlyPrecision::kDouble);
  write_obj(mesh, path("a.obj"));
  LoadLog log;
  expect_same_geometry(load_mesh(path("a.ply"), {}, log), mesh);
  expect_same_geometry(load_mesh(path("a.obj"), {}, log), mesh);
  EXPECT_TRUE(log.messages.empty());
}

TEST_F(Write, FloatPlyReadsBackRoundedToFloat) {
  const SurfaceMesh mesh = make_sphere(1.0 / 3, 0.1);
  write_ply(mesh, path("a.ply"));
  LoadLog log;
  const SurfaceMesh back = load_mesh(path("a.ply"), {}, log);
  ASSERT_EQ(back.vertex_count(), mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
    EXPECT_EQ(back.vertices.x[i], static_cast<double>(static_cast<float>(mesh.vertices.x[i])));
}

// The fixed layout: 3 floats a vertex; 13 bytes a face, 9 more when any face is a crack.
TEST_F(Write, PlyHasCrackColumnsOnlyWithCracks) {
  SurfaceMesh mesh = make_box({1, 1, 1}, 1);
  write_ply(mesh, path("plain.ply"));
  mesh.faces.kind[3] = FaceKind::kCrack, mesh.faces.crack[3] = 7, mesh.faces.source[2] = 5;
  write_ply(mesh, path("crack.ply"));
  const std::string plain = content(path("plain.ply")), crack = content(path("crack.ply"));
  const auto body = [](const std::string& text) { return text.size() - text.find("end_header\n") - 11; };
  EXPECT_EQ(body(plain), 8u * 12 + 12 * 13);
  EXPECT_EQ(body(crack), 8u * 12 + 12 * 25);
  EXPECT_EQ(plain.find("kind"), std::string::npos);
  ASSERT_NE(crack.find("property uchar kind\nproperty int crack\nproperty int source\nproperty char side\nproperty "
                       "ushort material\n"),
            std::string::npos);
  const std::string face3 = crack.substr(crack.find("end_header\n") + 11 + 8 * 12 + 3 * 25 + 13, 12);
  EXPECT_EQ(face3, std::string("\x01\x07\0\0\0\xFF\xFF\xFF\xFF\0\0\0", 12));
  LoadLog log;
  expect_same_geometry(load_mesh(path("crack.ply"), {}, log), mesh);
}

TEST_F(Write, BytesDependOnTheMeshAlone) {
  const SurfaceMesh mesh = make_goblet(0.2, 0.04, 0.0015, 0.01);
  write_ply(mesh, path("a.ply")), write_ply(mesh, path("b.ply"));
  write_obj(mesh, path("a.obj")), write_obj(mesh, path("b.obj"));
  EXPECT_EQ(content(path("a.ply")), content(path("b.ply")));
  EXPECT_EQ(content(path("a.obj")), content(path("b.obj")));
}

TEST_F(Write, LeavesNothingButTheFinishedFile) {
  write_ply(make_box({1, 1, 1}, 1), path("a.ply"));
  write_ply(make_box({1, 1, 1}, 0.5), path("a.ply"));  // replaces
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) files += entry.is_regular_file();
  EXPECT_EQ(files, 1u);
}

TEST_F(Write, ErrorsNameTheFile) {
  const SurfaceMesh mesh = make_box({1, 1, 1}, 1);
  std::filesystem::create_directories(path("folder.ply/inside"));
  for (const std::string& file : {path("missing/a.ply"), path("folder.ply")}) try {
      write_ply(mesh, file);
      FAIL() << file;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(file), std::string::npos) << e.what();
    }
  EXPECT_FALSE(std::filesystem::exists(path("folder.ply.part")));
}

}  // namespace
}  // namespace sherd
