// Corner channels from the file through repair and remeshing back to a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/mesh/attributes.h"
#include "engine/mesh/load.h"
#include "engine/mesh/repair.h"
#include "engine/mesh/resample.h"
#include "engine/mesh/shapes.h"
#include "engine/mesh/sizing.h"
#include "engine/mesh/validate.h"
#include "engine/mesh/write.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

class Channels : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("sherd_channels_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  std::string text_file(const char* name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

SurfaceMesh loaded(const std::string& path) {
  LoadLog log;
  return load_mesh(path, {}, log);
}

// Two charts that meet where x = 0, each linear in the place; "heat" is linear and has no seam.
float painted(const Vec3& p, bool right, std::size_t channel, int component) {
  if (channel == 1) return static_cast<float>(1 + 0.5 * p.x - p.y + 0.25 * p.z);
  return static_cast<float>((component == 0 ? 0.3 * p.x + 0.2 * p.z : 0.1 * p.x + 0.4 * p.y) + (right ? 10 : 0));
}

SurfaceMesh paint(SurfaceMesh mesh) {
  mesh.channels = {{"uv", 2, {}}, {"heat", 1, {}}};
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < mesh.channels[c].components; ++i)
          mesh.channels[c].value.push_back(painted(mesh.corner(t, k), mesh.centroid(t).x > 0, c, i));
  return mesh;
}

// Faces of a box are flat, so linear values survive exactly but for rounding: of the place to 1e-9 and of values near
// 10 to single precision, a few times over.
void expect_painted(const SurfaceMesh& mesh) {
  ASSERT_EQ(check_attributes(mesh), "");
  ASSERT_EQ(mesh.channels.size(), 2u);
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        for (int i = 0; i < mesh.channels[c].components; ++i) {
          const Vec3 p = mesh.corner(t, static_cast<int>(k));
          const auto n = static_cast<std::size_t>(mesh.channels[c].components);
          ASSERT_NEAR(mesh.channels[c].value[3 * n * t + k * n + static_cast<std::size_t>(i)],
                      painted(p, mesh.centroid(t).x > 0, c, i), 1e-5)
              << mesh.channels[c].name << " at (" << p.x << ", " << p.y << ", " << p.z << ")";
        }
}

SurfaceMesh painted_box() {
  return paint(make_box({2, 1, 1.5}, 0.25));  // eight cells along x: none crosses x = 0
}

TEST_F(Channels, SurviveAPlyRoundTripToTheBit) {
  const SurfaceMesh box = painted_box();
  write_ply(box, path("a.ply"), PlyPrecision::kDouble);
  const SurfaceMesh back = loaded(path("a.ply"));
  EXPECT_EQ(back.vertices, box.vertices);
  EXPECT_EQ(back.triangles, box.triangles);
  EXPECT_EQ(back.channels, box.channels);
}

TEST_F(Channels, TextureCoordinatesSurviveAnObjRoundTripToTheBit) {
  const SurfaceMesh box = painted_box();
  write_obj(box, path("a.obj"));
  const SurfaceMesh back = loaded(path("a.obj"));
  ASSERT_EQ(back.channels.size(), 1u);
  EXPECT_EQ(back.channels[0], box.channels[0]);
}

// A tetrahedron whose first corner has two texture coordinates and whose last face is a quadrangle's half.
TEST_F(Channels, ObjCornersOfOneVertexMayDiffer) {
  const std::string file = text_file("a.obj",
                                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0.5 0.25\nvt 1\nvt 0 1\nvt 7 8\n"
                                     "f 1/1 3/2 2/3\nf 1/-1 2/3 4/2\nf 2//1 3 4/1\nf 1/4/2 4/2 3/3\n");
  const SurfaceMesh mesh = loaded(file);
  ASSERT_EQ(mesh.channels.size(), 1u);
  const std::vector<float> expected = {0.5F, 0.25F, 1, 0, 0,    1,     7, 8, 0, 1, 1, 0,
                                       0,    0,     0, 0, 0.5F, 0.25F, 7, 8, 1, 0, 0, 1};
  EXPECT_EQ(mesh.channels[0].value, expected);
}

TEST_F(Channels, ObjTextureIndicesOutOfRangeAreRefused) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
  for (const char* face : {"f 1/2 2/1 3/1\n", "f 1/0 2/1 3/1\n", "f 1/x 2/1 3/1\n", "f 1/-2 2/1 3/1\n"})
    EXPECT_THROW(loaded(text_file("a.obj", vertices + face)), InputError) << face;
  EXPECT_THROW(loaded(text_file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt nan 0\nf 1 2 3\n")), InputError);
}

// As exporters write it: a vertex twice where a seam runs, joined on loading; the corners keep both values.
TEST_F(Channels, PlyVerticesJoinedAtASeamKeepBothValues) {
  const std::string file = text_file("a.ply",
                                     "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float "
                                     "y\nproperty float z\nproperty float nx\n"
                                     "property float s\nproperty float t\nproperty double heat\nproperty uchar red\n"
                                     "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
                                     "0 0 0 9 0.125 0.5 1 8\n1 0 0 9 0.25 0 2 8\n0 1 0 9 0.5 0 3 8\n0 0 1 9 0.75 0 4 "
                                     "8\n0 0 0 9 5 6 7 8\n1 0 0 9 1 1 9 8\n"
                                     "3 0 2 1\n3 4 5 3\n3 5 2 3\n3 4 3 2\n");
  const SurfaceMesh mesh = loaded(file);
  EXPECT_EQ(mesh.vertex_count(), 4u);
  ASSERT_EQ(mesh.channels.size(), 2u);
  EXPECT_EQ(mesh.channels[0].name, "uv");
  EXPECT_EQ(mesh.channels[1].name, "heat");
  const std::vector<float> uv = {0.125F, 0.5F, 0.5F, 0, 0.25F, 0, 5, 6, 1,     1, 0.75F, 0,
                                 1,      1,    0.5F, 0, 0.75F, 0, 5, 6, 0.75F, 0, 0.5F,  0};
  EXPECT_EQ(mesh.channels[0].value, uv);
  EXPECT_EQ(mesh.channels[1].value, (std::vector<float>{1, 3, 2, 7, 9, 4, 9, 3, 4, 7, 4, 3}));
}

TEST_F(Channels, PlyAttributesThatAreNoNumbersAreRefused) {
  EXPECT_THROW(loaded(text_file("a.ply",
                                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                                "float z\nproperty float s\nelement face 1\nproperty list uchar int vertex_indices\n"
                                "end_header\n0 0 0 nan\n1 0 0 0\n0 1 0 0\n3 0 1 2\n")),
               InputError);
}

TEST_F(Channels, HalvedEdgesKeepTheValueAtEachPoint) {
  expect_painted(with_edges_halved(painted_box(), 0.11));
}

// The seam across flat faces stays a line: no triangle mixes the charts.
TEST_F(Channels, RemeshedFlatFacesKeepTheValueAtEachPoint) {
  const SurfaceMesh box = painted_box();
  for (const Real edge : {0.13, 0.21, 0.4}) {
    RemeshOptions options;
    options.edge_length = edge;
    SurfaceMesh out;
    const RemeshReport report = remesh(box, options, out);
    ASSERT_EQ(report.status, RemeshStatus::kOk) << report.reason;
    EXPECT_GT(report.splits + report.collapses, 0u);
    expect_painted(out);
  }
}

// Charts of one triangle each would leave nothing to remesh; each new triangle then takes the values of one chart.
TEST_F(Channels, ChartsTooSmallForTheTargetDoNotHinderRemeshing) {
  SurfaceMesh box = make_box({1, 1, 1}, 0.2);
  box.channels = {{"uv", 2, {}}};
  for (std::size_t t = 0; t < box.triangle_count(); ++t)
    for (int k = 0; k < 6; ++k) box.channels[0].value.push_back(static_cast<float>(t));
  RemeshOptions options;
  options.edge_length = 0.3;
  SurfaceMesh out;
  const RemeshReport report = remesh(box, options, out);
  ASSERT_EQ(report.status, RemeshStatus::kOk) << report.reason;
  SurfaceMesh plain = box, plain_out;
  plain.channels.clear();
  remesh(plain, options, plain_out);
  EXPECT_EQ(out.triangles, plain_out.triangles);
  EXPECT_EQ(out.vertices, plain_out.vertices);
  EXPECT_EQ(check_attributes(out), "");
  for (std::size_t t = 0; t < out.triangle_count(); ++t)
    EXPECT_EQ(out.channels[0].value[6 * t], out.channels[0].value[6 * t + 5]) << "corners of different charts";
}

TEST_F(Channels, AClosedHoleTakesTheValuesAroundIt) {
  SurfaceMesh box = painted_box();
  std::vector<bool> keep(box.triangle_count(), true);
  keep[7] = keep[40] = false;
  keep_faces(box, keep);
  std::vector<std::string> messages;
  RepairOptions options;
  options.max_hole_diameter = 1;
  repair_mesh(box, options, messages);
  EXPECT_TRUE(is_valid(report_mesh(box)));
  expect_painted(box);
}

TEST_F(Channels, ChartsEndAtSeamsAndRegionsAtLargeChartsOnly) {
  const SurfaceMesh box = painted_box();
  const std::vector<std::uint32_t> chart = label_charts(box);
  for (std::size_t t = 0; t < chart.size(); ++t)
    EXPECT_EQ(chart[t] == chart[0], (box.centroid(t).x > 0) == (box.centroid(0).x > 0));
  const Real half = 0.5 * surface_area(box);
  const auto count = [](const std::vector<std::uint32_t>& label) {
    return *std::max_element(label.begin(), label.end()) + 1;
  };
  EXPECT_EQ(count(label_regions(box, true, 0.9 * half)), 2u);
  EXPECT_EQ(count(label_regions(box, true, 1.1 * half)), 1u);
  EXPECT_EQ(count(label_regions(box, false, 0)), 1u);
  EXPECT_TRUE(label_charts(make_box({1, 1, 1}, 0.5)).empty());
}

}  // namespace
}  // namespace sherd
