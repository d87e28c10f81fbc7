// What the tests of the indirect formulation share.
#pragma once
#include "engine/load/load.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/vec3.h"

namespace sherd {

// d f / d x_k by central differences of order eight. With h = 0.01 and fields that vary over lengths of about 1 the
// truncation h^8 f^(9) / 630 is about 1e-13, rounding 1e-16 / h times a few another 1e-14.
template <class F>
auto derivative(const F& f, const Vec3& x, int k, Real h) {
  constexpr Real kWeight[4] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  decltype(f(x)) sum{};
  for (int j = 1; j <= 4; ++j) {
    Vec3 step{};
    step[k] = h * j;
    sum += (f(x + step) - f(x - step)) * (kWeight[j - 1] / h);
  }
  return sum;
}

// Concentric spheres with the same triangles on both, the inner one oriented into the cavity.
inline SurfaceMesh make_shell(Real outer, Real inner, Real edge_of_unit_sphere) {
  const SurfaceMesh sphere = make_sphere(1, edge_of_unit_sphere);
  const auto n = static_cast<std::uint32_t>(sphere.vertex_count());
  SurfaceMesh mesh;
  for (const Real radius : {outer, inner})
    for (std::size_t i = 0; i < n; ++i) mesh.vertices.push_back(sphere.vertices[i] * radius);
  for (const Triangle& t : sphere.triangles) mesh.add_triangle(t[0], t[1], t[2]);
  for (const Triangle& t : sphere.triangles) mesh.add_triangle(n + t[0], n + t[2], n + t[1]);
  return mesh;
}

// One traction a face: traction(centroid, unit normal).
Load face_load(const SurfaceMesh& mesh, const auto& traction) {
  Load load;
  load.face_traction.resize(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    load.face_traction.set(t, traction(mesh.centroid(t), normalized(mesh.area_normal2(t))));
  return load;
}

}  // namespace sherd
