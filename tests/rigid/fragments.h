// Pieces of a cut body, as bodies.
#pragma once
#include "tests/fragment/slabs.h"
#include "tests/rigid/bodies.h"

namespace sherd {

// Fragments of `mesh` cut by wavy slabs one after the other, largest first.
inline std::vector<SurfaceMesh> shatter(const SurfaceMesh& mesh, const std::vector<SlabShape>& slabs) {
  std::vector<SurfaceMesh> pieces{mesh};
  for (const SlabShape& slab : slabs) {
    std::vector<SurfaceMesh> next;
    for (const SurfaceMesh& piece : pieces) {
      CutResult result = cut_of(piece, make_slab(slab));
      if (!result.ok || result.fragments.empty()) {
        next.push_back(piece);
        continue;
      }
      for (SurfaceMesh& f : result.fragments) next.push_back(std::move(f));
    }
    pieces = std::move(next);
  }
  return pieces;
}

// The pieces where they lay in the whole, its centre of mass (of `whole`) at `position`, as siblings of one step's
// fracture.
inline std::vector<Body> siblings(const std::vector<SurfaceMesh>& pieces, const Body& whole) {
  std::vector<Body> bodies;
  for (const SurfaceMesh& mesh : pieces) {
    Body b = whole;
    b.id = BodyId{whole.id.value + 1 + static_cast<std::uint32_t>(bodies.size())}, b.parent = whole.id;
    b.generation = 1;
    b.mesh = std::make_shared<const SurfaceMesh>(mesh);
    b.mass = mass_properties(mesh, b.density);
    b.pose.position = to_world(whole, b.mass.centre);
    bodies.push_back(std::move(b));
  }
  return bodies;
}

// A stoneware box of 8 cm broken in eight by three wavy cracks of the given width.
inline std::vector<SurfaceMesh> broken_box(Real crack) {
  const auto slab = [&](const Vec3& normal, Real shift, Real wave) {
    SlabShape s;
    s.centre = normal * shift, s.normal = normal, s.half_u = s.half_v = 0.12, s.cells = 24, s.thickness = crack;
    s.wave = wave, s.wave_number = 90;
    return s;
  };
  return shatter(
      make_box({0.08, 0.06, 0.07}, 0.015),
      {slab({1, 0.2, 0.1}, 0.003, 0.003), slab({0.1, 1, 0}, -0.002, 0.002), slab({0, 0.15, 1}, 0.001, 0.003)});
}

}  // namespace sherd
