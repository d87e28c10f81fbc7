// Meshes, exact fields and loads that the robustness laws of the direct solver share.
#pragma once
#include <span>

#include "engine/elastostatic/solver.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/random.h"
#include "kernels/fundamental/kelvin.h"

namespace sherd {

inline Vec3 random_vector(Random& random) {
  const Real x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

inline Mat3 random_matrix(Random& random) {
  Mat3 m;
  for (auto& row : m.m)
    for (Real& v : row) v = random.uniform(-1, 1);
  return m;
}

inline Sym3 random_stress(Random& random) {
  return symmetric_part(random_matrix(random));
}

// Orthonormal, by Gram-Schmidt.
inline Mat3 random_rotation(Random& random) {
  const Vec3 a = normalized(random_vector(random)), b = random_vector(random), c = normalized(b - a * dot(a, b));
  return Mat3::from_columns(a, c, cross(a, c));
}

inline SurfaceMesh transformed(SurfaceMesh mesh, const Mat3& a, const Vec3& shift = {}) {
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) mesh.vertices.set(v, a * mesh.vertices[v] + shift);
  return mesh;
}

// Both, with the second inside out: a cavity.
inline SurfaceMesh with_cavity(SurfaceMesh body, const SurfaceMesh& cavity) {
  const auto base = static_cast<std::uint32_t>(body.vertex_count());
  for (std::size_t v = 0; v < cavity.vertex_count(); ++v) body.vertices.push_back(cavity.vertices[v]);
  for (const Triangle& t : cavity.triangles) body.add_triangle(base + t[0], base + t[2], base + t[1]);
  return body;
}

// The same surface with `count` triangles split at a point `ratio` of their longest edge above it: each leaves a sliver
// of that ratio of altitude to length.
inline SurfaceMesh with_slivers(SurfaceMesh mesh, std::size_t count, Real ratio, std::uint64_t seed) {
  Random random(seed);
  const std::size_t triangles = mesh.triangle_count();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t t = (i * triangles) / count;
    const Triangle c = mesh.triangles[t];
    std::size_t k = 0;
    Real longest = 0;
    for (std::size_t e = 0; e < 3; ++e) {
      const Real l = distance(mesh.vertices[c[e]], mesh.vertices[c[(e + 1) % 3]]);
      if (l > longest) longest = l, k = e;
    }
    const Real altitude = norm(mesh.area_normal2(t)) / longest, high = ratio * longest / altitude,
               along = random.uniform(0.3, 0.7);
    const std::uint32_t p = c[k], q = c[(k + 1) % 3], r = c[(k + 2) % 3],
                        v = static_cast<std::uint32_t>(mesh.vertex_count());
    mesh.vertices.push_back((mesh.vertices[p] * (1 - along) + mesh.vertices[q] * along) * (1 - high) +
                            mesh.vertices[r] * high);
    mesh.triangles[t] = {p, q, v};
    mesh.add_triangle(q, r, v), mesh.add_triangle(r, p, v);
  }
  return mesh;
}

// Displacement u_i = 1/2 H_ijk x_j x_k that balances without body force for every H: what does not balance is taken
// out by a term along the coordinate itself. The stress is linear.
class QuadraticField {
 public:
  QuadraticField(const Elastic& material, std::uint64_t seed) : material_(material) {
    Random random(seed);
    for (auto& m : h_) {
      const Mat3 g = random_matrix(random);
      m = (g + transpose(g)) * 0.5;
    }
    // mu u_i,kk + (lambda + mu) u_k,ki = 0, made true through u_i,ii alone.
    const Real lambda = material.lambda(), mu = material.mu;
    for (int i = 0; i < 3; ++i) {
      Real rest = 0;
      for (int k = 0; k < 3; ++k) {
        if (k == i) continue;
        rest += mu * h_[i][k][k] + (lambda + mu) * h_[k][k][i];
      }
      h_[i][i][i] = -rest / (lambda + 2 * mu);
    }
  }
  Vec3 displacement(const Vec3& x) const {
    Vec3 u;
    for (int i = 0; i < 3; ++i) u[i] = 0.5 * dot(x, h_[i] * x);
    return u;
  }
  Mat3 gradient(const Vec3& x) const {
    Mat3 g;
    for (int i = 0; i < 3; ++i) {
      const Vec3 row = h_[i] * x;
      for (int k = 0; k < 3; ++k) g[i][k] = row[k];
    }
    return g;
  }
  Sym3 stress(const Vec3& x) const { return kelvin::hooke(gradient(x), material_); }

 private:
  Elastic material_;
  Mat3 h_[3];
};

// Tractions of a stress field that is at most quadratic on each triangle.
inline Load traction_load(const SurfaceMesh& mesh, const auto& stress) {
  Load load;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 n = normalized(mesh.area_normal2(t));
    for (int k = 0; k < 3; ++k) load.quadratic_traction.push_back(stress(mesh.corner(t, k)) * n);
    for (int k = 0; k < 3; ++k)
      load.quadratic_traction.push_back(stress((mesh.corner(t, k) + mesh.corner(t, (k + 1) % 3)) * 0.5) * n);
  }
  return load;
}

inline Vec3Column sample(const SurfaceMesh& mesh, const auto& field) {
  Vec3Column out;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) out.push_back(field(mesh.vertices[v]));
  return out;
}

inline std::vector<Real> interleaved(const Vec3Column& column) {
  std::vector<Real> out;
  for (std::size_t i = 0; i < column.size(); ++i) out.insert(out.end(), {column.x[i], column.y[i], column.z[i]});
  return out;
}

inline Real largest(std::span<const Real> values) {
  Real m = 0;
  for (const Real v : values) m = std::isfinite(v) ? std::max(m, std::abs(v)) : 1e300;
  return m;
}

inline Real largest(const Sym3& s) {
  const Real v[] = {s.xx, s.yy, s.zz, s.yz, s.xz, s.xy};
  return largest(v);
}

}  // namespace sherd
