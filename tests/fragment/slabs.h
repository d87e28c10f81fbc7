// Slabs for the cut's tests: sheets over a rectangle, thickened to closed meshes.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/fragment/cut.h"
#include "engine/mesh/validate.h"
#include "kernels/core/random.h"

namespace sherd {

struct SlabShape {
  Vec3 centre, normal{1, 0, 0};
  Real half_u = 2, half_v = 2;  // m, along two directions perpendicular to the normal
  int cells = 8;                // along each
  Real thickness = 0.01;        // m
  Real wave = 0, wave_number = 3, phase = 0.3;
  bool wedge = false;  // thickness falls to a shared edge at u = -half_u: the tip of a notch
};

inline SurfaceMesh make_slab(const SlabShape& s) {
  constexpr std::int32_t kCrackId = 7;
  const Vec3 n = normalized(s.normal), eu = any_perpendicular(n), ev = cross(n, eu);
  const auto side = static_cast<std::uint32_t>(s.cells + 1);
  SurfaceMesh mesh;
  std::vector<std::uint32_t> top(side * side), bottom(side * side);
  for (std::uint32_t i = 0; i < side; ++i)
    for (std::uint32_t j = 0; j < side; ++j) {
      const Real u = s.half_u * (2.0 * i / s.cells - 1), v = s.half_v * (2.0 * j / s.cells - 1);
      const Real w = s.wave * std::sin(s.wave_number * u + s.phase) * std::cos(0.7 * s.wave_number * v + 2 * s.phase);
      const Vec3 p = s.centre + u * eu + v * ev + w * n;
      const bool single = s.wedge && i == 0;
      top[i * side + j] = static_cast<std::uint32_t>(mesh.vertex_count());
      mesh.vertices.push_back(single ? p : p + 0.5 * s.thickness * n);
      bottom[i * side + j] = static_cast<std::uint32_t>(mesh.vertex_count() - (single ? 1 : 0));
      if (!single) mesh.vertices.push_back(p - 0.5 * s.thickness * n);
    }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh.add_triangle(a, b, c);
  };
  const auto rim = [&](std::uint32_t p, std::uint32_t q) {  // the sheet lies left of p -> q
    add(bottom[p], bottom[q], top[q]), add(bottom[p], top[q], top[p]);
  };
  for (std::uint32_t i = 0; i + 1 < side; ++i)
    for (std::uint32_t j = 0; j + 1 < side; ++j) {
      const std::uint32_t a = i * side + j, b = a + side, c = b + 1, d = a + 1;
      add(top[a], top[b], top[c]), add(top[a], top[c], top[d]);
      add(bottom[a], bottom[c], bottom[b]), add(bottom[a], bottom[d], bottom[c]);
    }
  for (std::uint32_t k = 0; k + 1 < side; ++k) {
    rim(k * side, (k + 1) * side);
    rim((side - 1) * side + k, (side - 1) * side + k + 1);
    rim((k + 1) * side + side - 1, k * side + side - 1);
    rim(k + 1, k);
  }
  mesh.faces.kind.assign(mesh.triangle_count(), FaceKind::kCrack);
  mesh.faces.crack.assign(mesh.triangle_count(), kCrackId);
  return mesh;
}

inline void number_sources(SurfaceMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) mesh.faces.source[t] = static_cast<std::int32_t>(t);
}

inline SurfaceMesh moved(SurfaceMesh mesh, const std::function<Vec3(const Vec3&)>& map) {
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) mesh.vertices.set(i, map(mesh.vertices[i]));
  return mesh;
}

inline Real total_volume(const CutResult& result) {
  Real sum = 0;
  for (const SurfaceMesh& f : result.fragments) sum += signed_volume(f);
  return sum;
}

// Closed, manifold, embedded fragments whose volumes balance to 1e-9 of the body's (V1; rounding alone stays near
// 1e-13).
inline void expect_good(const SurfaceMesh& body, const CutResult& result) {
  ASSERT_TRUE(result.ok) << result.reason;
  ASSERT_FALSE(result.fragments.empty());
  for (const SurfaceMesh& fragment : result.fragments) {
    const MeshReport report = report_mesh(fragment, {true, 10});
    EXPECT_TRUE(is_valid(report)) << to_text(report);
    EXPECT_EQ(fragment.faces.kind.size(), fragment.triangle_count());
  }
  const Real volume = signed_volume(body);
  EXPECT_LT(std::abs(volume - total_volume(result) - result.removed_volume - result.dust_volume), 1e-9 * volume);
}

inline CutOptions options_for(const SurfaceMesh& body) {
  CutOptions options;
  options.edge_length = mean_edge_length(body);
  return options;
}

inline CutResult cut_of(const SurfaceMesh& body, const SurfaceMesh& slab) {
  return cut(body, slab, options_for(body));
}

}  // namespace sherd
