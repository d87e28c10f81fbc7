// Laws of the stress on bodies and meshes that are nasty: every Poisson ratio, slivers, sheets that nearly touch, walls
// far thinner than an element, several cavities.
#include <gtest/gtest.h>

#include "engine/mesh/bvh.h"
#include "engine/stress/analysis.h"
#include "engine/stress/stress.h"
#include "kernels/core/error.h"
#include "tests/elastostatic/robust_support.h"

namespace sherd {
namespace {

const Elastic kMaterial{1, 0.3};

// In equilibrium, and linear: the displacement is quadratic, which elements carry exactly on flat faces.
Sym3 bending(const Vec3& x) {
  return {x.y, 0.3 * x.z, -0.5 * x.x, 0, 0, 0.2};
}
Sym3 uniform(const Vec3&) {
  return {1, 0.5, -0.3, 0.1, 0.2, 0.4};
}

struct Outcome {
  bool ok = false;
  std::string reason;
  std::vector<Sym3> corner;
  std::vector<std::uint32_t> vertex;  // of the corners
  std::vector<Sym3> inside;
};

Outcome solve(const SurfaceMesh& mesh, const Elastic& material, const Load& load, const Vec3Column& points = {}) {
  ElasticOptions options;
  options.double_storage = true, options.krylov.tolerance = 1e-8;
  const ElasticBody body(mesh, material, options);
  const SurfaceRecovery recovery(mesh, {});
  const TriangleBvh bvh(mesh);
  const ParticularSolution particular = body.particular(load);
  const ElasticSolution s = body.solve(load, particular);
  const StressState state(body, recovery, bvh, load, particular, s);
  Outcome out{s.ok, s.reason, state.corner_stress(), {}, {}};
  for (const StressCorner& c : recovery.corners()) out.vertex.push_back(c.vertex);
  state.evaluate(points, out.inside);
  return out;
}

// Largest error at a corner over the largest exact component.
Real error_of(const SurfaceMesh& mesh, const Outcome& o, const auto& exact) {
  Real error = 0, size = 0;
  for (std::size_t c = 0; c < o.corner.size(); ++c) {
    const Sym3 e = exact(mesh.vertices[o.vertex[c]]);
    error = std::max(error, largest(o.corner[c] - e)), size = std::max(size, largest(e));
  }
  return error / size;
}

constexpr Real kRatios[] = {-0.5, 0.0, 0.3, 0.45, 0.49, 0.499};

TEST(RobustStress, UniformStressIsExactOnAnyBodyAtAnyPoissonRatio) {
  const SurfaceMesh box = make_box({1, 0.8, 0.6}, 0.3);
  for (const SurfaceMesh& mesh :
       {box, make_plate(1, 1, 0.05, 0.25), make_sphere(0.5, 0.25), make_hollow_sphere(1, 0.6, 0.5),
        make_torus(0.5, 0.2, 0.2), with_slivers(box, 8, 1e-4, 3)})
    for (const Real nu : {-0.5, 0.3, 0.499}) {
      const Outcome o = solve(mesh, {1, nu}, traction_load(mesh, uniform));
      ASSERT_TRUE(o.ok) << o.reason;
      EXPECT_LT(error_of(mesh, o, uniform), 1e-9) << mesh.triangle_count() << " triangles, nu " << nu;
    }
}

TEST(RobustStress, LinearStressIsExactOnABoxAndWithinThreePercentOnASphereAtAnyPoissonRatio) {
  const SurfaceMesh box = make_box({1, 0.8, 0.6}, 0.2), sphere = make_sphere(0.5, 0.15);
  for (const Real nu : kRatios) {
    const Outcome flat = solve(box, {1, nu}, traction_load(box, bending));
    EXPECT_LT(error_of(box, flat, bending), 1e-5) << nu;  // the far rules: 6e-6 a panel
    const Outcome round = solve(sphere, {1, nu}, traction_load(sphere, bending));
    EXPECT_LT(error_of(sphere, round, bending), 0.03) << nu;  // (h / radius)^2 / 4 at h / radius = 0.3
  }
}

// Two squeezed strips on opposite sides, the same on the children of every triangle.
Load strips(const SurfaceMesh& good, const SurfaceMesh& bad, std::size_t slivers) {
  Load load;
  const std::size_t n = good.triangle_count();
  for (std::size_t t = 0; t < bad.triangle_count(); ++t) {
    const std::size_t parent = t < n ? t : ((t - n) / 2 * n) / slivers;
    const Vec3 c = good.centroid(parent), normal = normalized(good.area_normal2(parent));
    load.face_traction.push_back(std::abs(normal.x) > 0.9 && std::abs(c.y) < 0.2 ? normal : Vec3{});
  }
  return load;
}

TEST(RobustStress, SliversChangeTheStressElsewhereByLessThanAPercent) {
  const SurfaceMesh good = make_box({1, 0.8, 0.6}, 0.15);
  const std::size_t count = 8;
  const SurfaceMesh bad = with_slivers(good, count, 1e-4, 3);
  Vec3Column points;
  Random random(17);
  for (int i = 0; i < 40; ++i) {
    const Vec3 p = random_vector(random);
    points.push_back({0.45 * p.x, 0.35 * p.y, 0.25 * p.z});
  }
  const Outcome a = solve(good, kMaterial, strips(good, good, count), points),
                b = solve(bad, kMaterial, strips(good, bad, count), points);
  ASSERT_TRUE(b.ok) << b.reason;
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT(largest(a.inside[i] - b.inside[i]), 0.01) << "point " << i;  // of tractions of 1
  for (const Sym3& s : b.corner) EXPECT_LT(largest(s), 10);
  EXPECT_LT(error_of(bad, solve(bad, kMaterial, traction_load(bad, bending)), bending), 1e-5);
}

Load pull(const SurfaceMesh& mesh) {
  Load load;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    load.face_traction.push_back(std::abs(mesh.centroid(t).y) > 0.499 ? normalized(mesh.area_normal2(t)) : Vec3{});
  return load;
}

// A slot across the pull, as thin as a crack: its stress field depends on the gap by about gap / length.
TEST(RobustStress, AThinSlotActsAsAWiderOneDoes) {
  const SurfaceMesh box = make_box({1, 1, 1}, 0.2);
  Vec3Column points;
  for (const Vec3& p : {Vec3{0.4, 0, 0}, {0, 0.3, 0}, {0.3, 0.3, 0.3}, {0, 0.2, 0.4}}) points.push_back(p);
  std::vector<Outcome> outcome;
  for (const Real gap : {1e-2, 1e-3, 1e-4}) {  // of an edge
    const SurfaceMesh mesh = with_cavity(box, make_box({0.4, gap * 0.1, 0.4}, 0.1));
    outcome.push_back(solve(mesh, kMaterial, pull(mesh), points));
    ASSERT_TRUE(outcome.back().ok) << gap << outcome.back().reason;
    EXPECT_LT(error_of(mesh, solve(mesh, kMaterial, traction_load(mesh, bending)), bending), 0.01) << gap;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT(largest(outcome[1].inside[i] - outcome[0].inside[i]), 0.01) << i;
    EXPECT_LT(largest(outcome[2].inside[i] - outcome[0].inside[i]), 0.01) << i;
  }
  EXPECT_LT(outcome[1].inside[1].yy, 0.85);  // the slot shields what lies behind it: 1 without it
}

// A cavity right under the surface.
SurfaceMesh thin_lid(Real thickness) {
  return with_cavity(make_box({1, 1, 1}, 0.2),
                     transformed(make_box({0.6, 0.4, 0.6}, 0.15), Mat3::identity(), {0, 0.3 - thickness, 0}));
}

TEST(RobustStress, AWallOfAThousandthOfAnEdgeCarriesLinearStressExactly) {
  for (const Real thickness : {1e-2, 1.5e-4}) {
    const SurfaceMesh mesh = thin_lid(thickness);
    const Outcome o = solve(mesh, kMaterial, traction_load(mesh, bending));
    ASSERT_TRUE(o.ok) << o.reason;
    EXPECT_LT(error_of(mesh, o, bending), 1e-4) << thickness;  // the far rules' 6e-6, over the wall's softness
  }
}

// Nothing can be right there; what must not happen is a number without a word.
TEST(RobustStress, WallsThatElementsCannotResolveAreReported) {
  std::vector<SurfaceMesh> meshes{thin_lid(1.5e-4), thin_lid(0.02)};
  for (const Real thickness : {1e-2, 1e-3, 1e-4}) meshes.push_back(make_plate(1, 1, thickness, 0.15));
  SurfaceMesh twins = make_box({1, 1, 1}, 0.25);
  for (const Real side : {-1.0, 1.0})
    twins = with_cavity(twins, transformed(make_box({0.5, 0.2, 0.5}, 0.15), Mat3::identity(), {0, side * 0.1001, 0}));
  meshes.push_back(twins);
  for (const SurfaceMesh& mesh : meshes) {
    Analysis analysis(mesh, kMaterial, {});
    Vec3Column traction(mesh.triangle_count());
    for (std::size_t t = 0; t < traction.size(); ++t)
      traction.set(t, {0, mesh.centroid(t).x * mesh.centroid(t).x, mesh.centroid(t).y});
    const bool solved = analysis.solve(traction, {});
    const AnalysisReport& r = analysis.report();
    EXPECT_FALSE(r.warnings.empty()) << mesh.triangle_count();
    for (const SolidReport& s : r.solids) EXPECT_TRUE(s.solved || !s.reason.empty());
    if (!solved) continue;
    Vec3Column points;
    for (std::size_t t = 0; t < mesh.triangle_count(); t += 9) points.push_back(mesh.centroid(t));
    std::vector<std::uint32_t> face;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); t += 9) face.push_back(t);
    std::vector<Sym3> stress;
    analysis.stress(analysis.locate(points, face), stress);
    for (const Sym3& s : stress) EXPECT_LT(largest(s), 1e299);
  }
}

SurfaceMesh side_by_side(const SurfaceMesh& a, Real gap) {
  SurfaceMesh out = a;
  const auto base = static_cast<std::uint32_t>(a.vertex_count());
  for (std::size_t v = 0; v < a.vertex_count(); ++v) out.vertices.push_back(a.vertices[v] + Vec3{1 + gap, 0, 0});
  for (const Triangle& t : a.triangles) out.add_triangle(t[0] + base, t[1] + base, t[2] + base);
  return out;
}

TEST(RobustStress, SolidsThatNearlyTouchDoNotFeelEachOther) {
  const SurfaceMesh box = make_box({1, 1, 1}, 0.25), pair = side_by_side(box, 2.5e-4);
  const auto traction_of = [](const SurfaceMesh& mesh) {
    Vec3Column out(mesh.triangle_count());
    for (std::size_t t = 0; t < out.size(); ++t)
      out.set(t, std::abs(mesh.centroid(t).y) > 0.49 ? normalized(mesh.area_normal2(t)) * (1 + mesh.centroid(t).z)
                                                     : Vec3{});
    return out;
  };
  Vec3Column points;
  for (const Vec3& p : {Vec3{0.1, 0.2, 0.3}, {0.4999, 0.1, 0.1}, {-0.3, 0.45, 0.2}}) points.push_back(p);
  std::vector<Sym3> alone, together;
  for (const bool both : {false, true}) {
    const SurfaceMesh& mesh = both ? pair : box;
    Analysis analysis(mesh, kMaterial, {});
    ASSERT_TRUE(analysis.solve(traction_of(mesh), {}));
    analysis.stress(analysis.locate(points, {}), both ? together : alone);
  }
  EXPECT_EQ(alone, together);
}

TEST(RobustStress, CoincidentSheetsAreRefused) {
  const SurfaceMesh box = make_box({1, 1, 1}, 0.25);
  const SurfaceMesh no_lid =
      with_cavity(box, transformed(make_box({0.5, 0.5, 0.5}, 0.25), Mat3::identity(), {0, 0.25, 0}));
  for (const SurfaceMesh& mesh : {side_by_side(box, 0), no_lid})
    EXPECT_THROW(Analysis(mesh, kMaterial, {}), InputError);
}

TEST(RobustStress, SeveralCavitiesCarryLinearStressExactly) {
  SurfaceMesh mesh = make_box({1.2, 1, 1}, 0.25);
  for (const Vec3& c : {Vec3{-0.3, 0, 0}, {0.3, 0.1, 0}})
    mesh = with_cavity(mesh, transformed(make_box({0.4, 0.4, 0.4}, 0.13), Mat3::identity(), c));
  for (const Real nu : {-0.5, 0.3, 0.499}) {
    const Outcome o = solve(mesh, {1, nu}, traction_load(mesh, bending));
    ASSERT_TRUE(o.ok) << o.reason;
    // The far rules' 6e-6 over the stiffness of a cavity against a change of volume, 1 - 2 nu.
    EXPECT_LT(error_of(mesh, o, bending), 1e-5 / (1 - 2 * nu)) << nu;
  }
}

}  // namespace
}  // namespace sherd
