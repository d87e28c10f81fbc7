// Laws of the reconstructed displacement.
#include "engine/elastostatic/reconstruction.h"

#include <gtest/gtest.h>

#include "tests/elastostatic/robust_support.h"

namespace sherd {
namespace {

ReconstructionOptions with_angle(Real angle) {
  return {Element::kCubic, angle, {}};
}

std::vector<SurfaceMesh> polyhedra() {
  const SurfaceMesh box = make_box({1, 0.8, 1.3}, 0.25);
  return {box, make_sphere(0.7, 0.2), make_hollow_sphere(1, 0.6, 0.4), make_goblet(1, 0.25, 0.02, 0.08),
          with_slivers(box, 12, 1e-4, 5)};
}

// Positions of the nodes on the flat triangles.
Vec3Column node_positions(const SurfaceMesh& mesh, const Reconstruction& r) {
  Vec3Column out(r.node_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto& node = r.nodes(t);
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(t, k), d = mesh.corner(t, (k + 1) % 3) - p;
      const auto i = static_cast<std::size_t>(k);
      out.set(node[i], p), out.set(node[3 + 2 * i], p + d * (1.0 / 3)), out.set(node[4 + 2 * i], p + d * (2.0 / 3));
    }
    out.set(node[9], mesh.centroid(t));
  }
  return out;
}

// Largest error at a node of the reconstructed vertex field, for nodes that `pick` wants (number in its triangle).
Real node_error(const SurfaceMesh& mesh, const Reconstruction& r, const auto& field, const auto& pick) {
  Vec3Column nodes;
  r.apply(sample(mesh, field), nodes);
  const Vec3Column x = node_positions(mesh, r);
  Real error = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::size_t a = 0; a < cubic::kNodes; ++a)
      if (pick(a)) error = std::max(error, norm(nodes[r.nodes(t)[a]] - field(x[r.nodes(t)[a]])));
  return error;
}
bool every(std::size_t) {
  return true;
}

TEST(Reconstruction, ReproducesRigidMotionsOnAnyPolyhedron) {
  const auto rigid = [](const Vec3& x) { return Vec3{0.4, -0.3, 0.9} + cross(Vec3{0.2, 0.8, -0.5}, x); };
  for (const SurfaceMesh& mesh : polyhedra())
    for (const Real nu : {-0.5, 0.3, 0.499})
      for (const Real angle : {0.0, 35.0, 180.0}) {
        const Reconstruction r(mesh, nu, with_angle(angle));
        // Rounding of a sum of up to a hundred terms of order 1.
        EXPECT_LT(node_error(mesh, r, rigid, every), 1e-13) << mesh.triangle_count() << " " << nu << " " << angle;
      }
}

TEST(Reconstruction, ReproducesAffineFieldsOnFlatFacesAndTheExactPolyhedron) {
  Random random(3);
  const Mat3 g = random_matrix(random);
  const auto affine = [&](const Vec3& x) { return g * x; };
  const SurfaceMesh box = make_box({1, 0.8, 1.3}, 0.25), sphere = make_sphere(0.7, 0.2);
  EXPECT_LT(node_error(box, Reconstruction(box, 0.3, {}), affine, every), 1e-13);
  EXPECT_LT(node_error(sphere, Reconstruction(sphere, 0.3, with_angle(0)), affine, every), 1e-13);
}

// On curved surfaces the nodes lie off the fitted surface; what the field does across it follows from Hooke's law with
// no traction across the fit's normal.
TEST(Reconstruction, DerivesTheInwardDerivativeOfAffineFieldsFromAFreeSurface) {
  const SurfaceMesh mesh = make_goblet(1, 0.25, 0.02, 0.08);
  for (const Real nu : {-0.5, 0.0, 0.3, 0.499}) {
    const Reconstruction r(mesh, nu, {});
    const SurfaceCorners corners = make_surface_corners(mesh, 35);
    Random random(8);
    for (std::size_t c = 0; c < corners.corner.size(); c += 17) {
      const SurfaceFit fit(mesh, corners, c, {});
      const Vec3 e1 = fit.a(), e2 = fit.b(), n = fit.normal();
      const Vec3 ta = e1 + n * fit.slope_x(), tb = e2 + n * fit.slope_y();
      // Plane stress in the tangent plane, then its strain with any rotation added.
      const Real s1 = random.uniform(-1, 1), s2 = random.uniform(-1, 1), s12 = random.uniform(-1, 1);
      const Mat3 sigma = outer(e1, e1) * s1 + outer(e2, e2) * s2 + (outer(e1, e2) + outer(e2, e1)) * s12;
      const Mat3 g = sigma * (1 + nu) - Mat3::identity() * (nu * trace(sigma)) + cross_matrix(random_vector(random));
      const Reconstruction::Frame& f = r.frame(static_cast<std::uint32_t>(c));
      const Vec3 w = f.x * (g * ta) + f.y * (g * tb);
      EXPECT_LT(norm(w + g * n), 1e-12) << "corner " << c << ", nu " << nu;
    }
  }
}

TEST(Reconstruction, ReproducesQuadraticFieldsOnFlatFaces) {
  const QuadraticField field({2.0, 0.3}, 4);
  const auto u = [&](const Vec3& x) { return field.displacement(x); };
  for (const SurfaceMesh& mesh : {make_box({1, 0.8, 1.3}, 0.2), make_plate(1, 0.7, 0.3, 0.1)})
    EXPECT_LT(node_error(mesh, Reconstruction(mesh, 0.3, {}), u, every), 1e-12);  // amplification of the fits up to 8
}

// Cubic along every edge; the centre, made from quadratics, misses by a cubic term.
TEST(Reconstruction, ReproducesCubicFieldsOnTheEdgesOfFlatFaces) {
  const SurfaceMesh mesh = make_box({1, 0.8, 1.3}, 0.1);
  const auto u = [](const Vec3& x) {
    return Vec3{x.x * x.x * x.y - x.z * x.z * x.z, x.x * x.y * x.z, x.y * x.y * x.y + x.x * x.z * x.z};
  };
  const Reconstruction r(mesh, 0.3, {});
  EXPECT_LT(node_error(mesh, r, u, [](std::size_t a) { return a < 9; }), 1e-12);
  // A centroid lies h/sqrt(3) from its vertices and the cubic bubble of x^3 is about h^3/27 times a few.
  EXPECT_LT(node_error(mesh, r, u, every), 1e-3);
}

TEST(Reconstruction, TransposeIsTheTranspose) {
  Random random(6);
  for (const SurfaceMesh& mesh : polyhedra()) {
    const Reconstruction r(mesh, 0.3, {});
    Vec3Column u, f, su;
    for (std::size_t v = 0; v < r.vertex_count(); ++v) u.push_back(random_vector(random));
    for (std::size_t i = 0; i < r.node_count(); ++i) f.push_back(random_vector(random));
    r.apply(u, su);
    const Vec3Column tf = r.apply_transpose(f);
    Real left = 0, right = 0, size = 0;
    for (std::size_t i = 0; i < su.size(); ++i) left += dot(su[i], f[i]), size += norm(su[i]) * norm(f[i]);
    for (std::size_t v = 0; v < u.size(); ++v) right += dot(u[v], tf[v]);
    EXPECT_NEAR(left, right, 1e-13 * size);  // rounding of the two sums
  }
}

TEST(Reconstruction, RowsAreTheRowsOfApply) {
  Random random(7);
  for (const SurfaceMesh& mesh : polyhedra())
    for (const Real angle : {0.0, 35.0}) {
      const Reconstruction r(mesh, 0.4, with_angle(angle));
      Vec3Column u, nodes;
      for (std::size_t v = 0; v < r.vertex_count(); ++v) u.push_back(random_vector(random));
      r.apply(u, nodes);
      for (std::uint32_t i = 0; i < r.node_count(); i += 7) {
        Vec3 sum;
        Real size = 0;
        for (const auto& [v, block] : r.row(i)) sum += block * u[v], size += norm(block * u[v]);
        EXPECT_LT(norm(sum - nodes[i]), 1e-13 * (1 + size));
      }
    }
}

TEST(Reconstruction, LinearElementsInterpolateTheirCorners) {
  Random random(9);
  const SurfaceMesh mesh = make_sphere(0.7, 0.2);
  const Reconstruction r(mesh, 0.3, {Element::kLinear, 35, {}});
  Vec3Column u, nodes;
  for (std::size_t v = 0; v < r.vertex_count(); ++v) u.push_back(random_vector(random));
  r.apply(u, nodes);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (const auto& [s, w] : {std::pair{0.2, 0.3}, {0.6, 0.1}, {0.0, 0.5}}) {
      Vec3 cubic_value;
      for (std::size_t a = 0; a < cubic::kNodes; ++a)
        cubic_value += nodes[r.nodes(t)[a]] * cubic::evaluate(cubic::kShape[a], s, w);
      const Triangle& c = mesh.triangles[t];
      EXPECT_LT(norm(cubic_value - (u[c[0]] * (1 - s - w) + u[c[1]] * s + u[c[2]] * w)), 1e-14);
    }
}

TEST(Reconstruction, IsContinuousAcrossEveryEdge) {
  for (const SurfaceMesh& mesh : polyhedra()) {
    const Reconstruction r(mesh, 0.3, {});
    const std::vector<std::uint32_t> twin = build_twins(mesh);
    for (std::uint32_t e = 0; e < twin.size(); ++e) {
      const auto &a = r.nodes(e / 3), &b = r.nodes(twin[e] / 3);
      const std::size_t k = e % 3, m = twin[e] % 3;
      EXPECT_EQ(a[3 + 2 * k], b[4 + 2 * m]);
      EXPECT_EQ(a[4 + 2 * k], b[3 + 2 * m]);
    }
  }
}

}  // namespace
}  // namespace sherd
