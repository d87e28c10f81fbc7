// Laws of the load stage: forces are kept, loads balance, the patch does not depend on the mesh.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/load/hertz.h"
#include "engine/load/patch.h"
#include "engine/load/surface_load.h"
#include "engine/mesh/shapes.h"

namespace sherd {
namespace {

struct Prepared {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> twins;
  TriangleBvh bvh;
  explicit Prepared(SurfaceMesh m) : mesh(std::move(m)), twins(build_twins(mesh)), bvh(mesh) {}
};

Vec3 panel_force(const TractionPanels& p) {
  Vec3 f;
  for (std::size_t i = 0; i < p.size(); ++i)
    f += p.traction[i] * (0.5 * norm(cross(p.corners[i][1] - p.corners[i][0], p.corners[i][2] - p.corners[i][0])));
  return f;
}

TEST(ContactPatch, CarriesTheWholeForceWhateverItsSize) {
  const Prepared s(make_sphere(0.1, 0.02));
  const Vec3 force{30, -500, 12};
  for (const Real radius : {1e-7, 1e-4, 0.003, 0.02, 0.09}) {
    const ContactPatch patch = make_patch(s.mesh, s.twins, s.bvh, {0, -0.1, 0}, radius, force);
    TractionPanels panels;
    append_panels(s.mesh, patch, panels);
    EXPECT_LT(norm(panel_force(panels) - force), 1e-11 * norm(force)) << radius;
  }
}

TEST(ContactPatch, PressureDoesNotDependOnTheMesh) {
  // The Hertz weight integrates to 2/3 pi a^2 on a plane: traction at the centre = F / (2/3 pi a^2).
  const Real a = 0.03, exact = 1000 / (2.0 / 3 * std::numbers::pi * a * a);
  for (const Real edge : {0.1, 0.05, 0.02}) {
    const Prepared box(make_box({0.4, 0.2, 0.4}, edge));
    const Vec3 top{0.013, bounding_box(box.mesh).high.y, -0.007};
    Load load;
    load.patches.push_back(make_patch(box.mesh, box.twins, box.bvh, top, a, {0, -1000, 0}));
    const Vec3 t = traction_at(load, box.mesh, top, box.bvh.closest(top).face);
    EXPECT_NEAR(t.y, -exact,
                0.02 * exact);  // panels of a third of the radius: centroid rule errs by about 1 % at the rim
  }
}

TEST(ContactPatch, LeavesTheFarSideOfAThinWallFree) {
  const Prepared plate(make_plate(0.4, 0.4, 0.005, 0.02));
  const ContactPatch patch =
      make_patch(plate.mesh, plate.twins, plate.bvh, {0.01, bounding_box(plate.mesh).high.y, 0.02}, 0.05, {0, -1, 0});
  ASSERT_GT(patch.faces.size(), 4u);
  for (const std::uint32_t f : patch.faces) EXPECT_GT(plate.mesh.area_normal2(f).y, 0);
}

TEST(InertiaRelief, BalancesForceAndMomentOfAnyContacts) {
  for (SurfaceMesh mesh :
       {make_sphere(0.1, 0.03), make_box({0.3, 0.1, 0.2}, 0.05), make_hollow_sphere(0.1, 0.06, 0.03)}) {
    const Prepared s(std::move(mesh));
    const MassProperties mass = mass_properties(s.mesh, 2400);
    const std::vector<BodyContact> contacts = {{{0.1, 0.02, 0.03}, {-100, 40, 30}, 1e-3, 0.02},
                                               {{-0.02, -0.1, 0.01}, {5, 900, -80}, 1e-3, 0.01}};
    const Vec3 omega{3, -8, 5};
    const Load load = make_load(s.mesh, mass, contacts, s.twins, s.bvh, omega);
    // Independently of make_load's own bookkeeping: body force by quadrature over the tetrahedra to an inner point
    // (degree 2).
    Vec3 force = panel_force(load.panels), moment;
    for (std::size_t i = 0; i < load.panels.size(); ++i) {
      const auto& c = load.panels.corners[i];
      moment += cross((c[0] + c[1] + c[2]) / 3.0 - mass.centre,
                      load.panels.traction[i] * (0.5 * norm(cross(c[1] - c[0], c[2] - c[0]))));
    }
    const Real p = 0.5854101966249685, q = 0.1381966011250105;
    for (std::size_t t = 0; t < s.mesh.triangle_count(); ++t) {
      const Vec3 v[4] = {mass.centre, s.mesh.corner(t, 0), s.mesh.corner(t, 1), s.mesh.corner(t, 2)};
      const Real volume = dot(v[1] - v[0], cross(v[2] - v[0], v[3] - v[0])) / 6;
      for (int k = 0; k < 4; ++k) {
        Vec3 x;
        for (int j = 0; j < 4; ++j) x += v[j] * (j == k ? p : q);
        const Vec3 b =
            (load.body_force.constant + load.body_force.linear * (x - load.body_force.origin)) * (volume / 4);
        force += b, moment += cross(x - mass.centre, b);
      }
    }
    const Real size = 1000;
    EXPECT_LT(norm(force), 1e-9 * size);
    EXPECT_LT(norm(moment), 1e-9 * size * 0.1);
    EXPECT_LT(norm(load.net_force), 1e-9 * size);
    EXPECT_LT(norm(load.net_moment), 1e-9 * size * 0.1);
  }
}

TEST(Hertz, ImpactOfASteelBallOnARigidPlaneMatchesJohnsonsFormula) {
  // t = 2.94 delta/v at the deepest approach; the two forms agree: delta = (15 m v^2 / (16 sqrt(R) E))^(2/5).
  const Real m = 0.033, r = 0.01, e = effective_modulus(210e9, 0.3, 0, 0), v = 1.2;
  const Real delta = std::pow(15 * m * v * v / (16 * std::sqrt(r) * e), 0.4);
  EXPECT_NEAR(hertz_duration(m, r, e, v), 2.94 * delta / v, 0.005 * 2.94 * delta / v);  // 2.87 and 2.94 are rounded
  EXPECT_NEAR(effective_modulus(200e9, 0.3, 200e9, 0.3), 0.5 * effective_modulus(200e9, 0.3, 0, 0), 1);
}

TEST(CurvatureRadius, FindsTheRadiusOfASphereAndTheDiagonalOfAFlatFace) {
  const Prepared s(make_sphere(0.1, 0.01));
  EXPECT_NEAR(curvature_radius(s.mesh, s.twins, s.bvh, {0, -0.1, 0}), 0.1, 0.01);
  const Prepared box(make_box({0.4, 0.4, 0.4}, 0.02));
  EXPECT_DOUBLE_EQ(curvature_radius(box.mesh, box.twins, box.bvh, {0.01, bounding_box(box.mesh).low.y, 0.02}),
                   bounding_box(box.mesh).diagonal());
}

TEST(BodyContact, DurationIsHertzAboveTheFloorAndTheStepAtRest) {
  Body body;
  body.id = BodyId{0};
  body.mesh = std::make_shared<SurfaceMesh>(make_sphere(0.1, 0.03));
  body.material.young = 1e7;  // soft, so that the Hertz time is long
  body.mass = mass_properties(*body.mesh, 1000);
  Contact c;
  c.a = body.id, c.b = kGround, c.impulse = {0, 2, 0}, c.approach_speed = 2, c.at_a = {0, -0.1, 0};
  ContactLoadOptions options;
  const BodyContact soft = body_contact(body, nullptr, c, 0.1, 0.3, options);
  EXPECT_NEAR(soft.duration,
              hertz_duration(body.mass.mass, 0.1, effective_modulus(1e7, body.material.poisson, 0, 0), 2), 1e-12);
  EXPECT_NEAR(norm(soft.force), 2 / soft.duration, 1e-9);
  EXPECT_EQ(soft.point, c.at_a);  // where they met, not where the body went since
  body.material.young = 70e9;
  EXPECT_DOUBLE_EQ(body_contact(body, nullptr, c, 0.1, 0.3, options).duration, options.min_duration);
  options.min_duration = 1e-6;
  EXPECT_LT(body_contact(body, nullptr, c, 0.1, 0.3, options).duration, 1e-3);
  c.approach_speed = 0.005;
  EXPECT_DOUBLE_EQ(body_contact(body, nullptr, c, 0.1, 0.3, options).duration, options.time_step);
  options.duration = 4e-4;
  EXPECT_DOUBLE_EQ(body_contact(body, nullptr, c, 0.1, 0.3, options).duration, 4e-4);
}

}  // namespace
}  // namespace sherd
