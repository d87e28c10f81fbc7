#include "engine/mesh/certificate.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/mesh/shapes.h"
#include "tests/mesh/mesh_edits.h"

namespace sherd {
namespace {

TEST(Certificate, KnownSolidsHaveTheirShellsCavitiesAndGenus) {
  const MeshCertificate torus = certify(make_torus(1, 0.4, 0.25));
  EXPECT_TRUE(torus.ok()) << torus.first_defect;
  EXPECT_EQ(torus.genus, 1);
  EXPECT_EQ(torus.shells, 1u);
  EXPECT_EQ(torus.cavities, 0u);
  const MeshCertificate hollow = certify(make_hollow_sphere(1, 0.6, 0.3));
  EXPECT_TRUE(hollow.ok()) << hollow.first_defect;
  EXPECT_EQ(hollow.genus, 0);
  EXPECT_EQ(hollow.shells, 2u);
  EXPECT_EQ(hollow.cavities, 1u);
}

struct Defect {
  const char* name;
  std::function<void(SurfaceMesh&)> make;
  const char* says;
  bool MeshCertificate::*fails;
};

TEST(Certificate, EachDefectIsNamedAndFailsItsOwnMark) {
  const std::vector<Defect> defects = {
      {"hole", [](SurfaceMesh& m) { m.triangles.pop_back(), m.faces = {}, m.faces.resize(m.triangles.size()); },
       "border edges", &MeshCertificate::closed},
      {"turned face", [](SurfaceMesh& m) { std::swap(m.triangles[3][0], m.triangles[3][1]); }, "opposite sides",
       &MeshCertificate::oriented},
      {"inside out", [](SurfaceMesh& m) { m = flipped(std::move(m)); }, "inside out", &MeshCertificate::oriented},
      {"two boxes through each other",
       [](SurfaceMesh& m) {
         m = joined(m, m, {0.31, 0.37, 0.41});
       },
       "intersect", &MeshCertificate::embedded},
      {"two boxes at one vertex",
       [](SurfaceMesh& m) {
         const std::uint32_t n = static_cast<std::uint32_t>(m.vertex_count());
         std::uint32_t low = 0, high = 0;
         for (std::uint32_t i = 0; i < n; ++i) {
           const auto sum = [&](std::uint32_t v) { return m.vertices.x[v] + m.vertices.y[v] + m.vertices.z[v]; };
           if (sum(i) < sum(low)) low = i;
           if (sum(i) > sum(high)) high = i;
         }
         m = joined(m, m, m.vertices[high] - m.vertices[low]);
         for (Triangle& t : m.triangles)
           for (std::uint32_t& v : t)
             if (v == n + low) v = high;
       },
       "non-manifold vertices", &MeshCertificate::manifold},
      {"not a number", [](SurfaceMesh& m) { m.vertices.x[2] = std::numeric_limits<Real>::quiet_NaN(); }, "not finite",
       &MeshCertificate::closed},
      {"index", [](SurfaceMesh& m) { m.triangles[1][1] = 100000; }, "out of range", &MeshCertificate::closed},
      {"column", [](SurfaceMesh& m) { m.faces.side.pop_back(); }, "face columns", &MeshCertificate::attributed},
      {"empty", [](SurfaceMesh& m) { m = {}; }, "no triangles", &MeshCertificate::closed}};
  for (const Defect& d : defects) {
    SurfaceMesh mesh = make_box({1, 1, 1}, 0.5);
    d.make(mesh);
    const MeshCertificate c = certify(mesh);
    EXPECT_FALSE(c.ok()) << d.name;
    EXPECT_NE(c.first_defect.find(d.says), std::string::npos) << d.name << ": " << c.first_defect;
    EXPECT_FALSE(c.*d.fails) << d.name;
  }
}

TEST(Certificate, JsonHoldsTheMembers) {
  const MeshCertificate c = certify(make_box({1, 2, 3}, 0.5));
  const auto j = nlohmann::json::parse(to_json(c));
  EXPECT_TRUE(j.at("ok").get<bool>());
  EXPECT_EQ(j.at("triangles").get<std::size_t>(), c.triangles);
  EXPECT_DOUBLE_EQ(j.at("volume").get<Real>(), c.volume);
  EXPECT_EQ(j.at("below_1_degree").get<std::size_t>(), 0u);
}

}  // namespace
}  // namespace sherd
