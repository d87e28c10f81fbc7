// A body under a load from its stress to its crack: the stages of an event without the simulation around them.
#pragma once
#include <gtest/gtest.h>

#include "engine/fracture/initiate.h"
#include "engine/fracture/net_section.h"
#include "tests/physics/helix.h"
#include "tools/exact/breakage.h"
#include "tools/exact/solve.h"

namespace sherd {

// A load on a body, solved.
struct Breaking {
  exact::Breakage body;
  exact::Solved solved;
  std::unique_ptr<StressCrackField> field;

  explicit Breaking(exact::Breakage b) : body(std::move(b)) {
    solved = exact::solve(body.mesh, body.material, exact::breakage_load(body, body.mesh), {});
    if (solved.ok) field = std::make_unique<StressCrackField>(state());
  }
  const StressState& state() const { return static_cast<const StressState&>(*solved.field); }
  const TriangleBvh& bvh() const { return *solved.bvh; }
  std::vector<CrackSeed> seeds(Real strength) const {
    return find_seeds(solved.mesh, *solved.recovery, state(), *constant_field(strength));
  }
  CrackSeed strongest() const { return strongest_point(solved.mesh, *solved.recovery, state(), *constant_field(1)); }

  GrowthOptions options(Real propagation_strength) const {
    GrowthOptions o;
    o.edge_length = body.edge, o.propagation_strength = propagation_strength;
    o.thickness = 1e-3 * bounding_box(body.mesh).diagonal();
    return o;
  }
  // As in a fracture event: a stopped crack goes through where its ligament cannot bear the load.
  GrowthResult grow(const CrackSeed& seed, const GrowthOptions& o) const {
    GrowthResult grown = grow_crack(bvh(), *field, seed, o);
    if (grown.outcome != GrowthOutcome::kArrested) return grown;
    NetSection net = net_section(bvh(), *field, grown.sheet, o);
    return net.complete && net.stress >= o.propagation_strength ? std::move(net.through) : grown;
  }
};

inline SurfaceMesh mesh_of(const CrackSheet& sheet) {
  SurfaceMesh mesh;
  mesh.vertices = sheet.position;
  for (const Triangle& t : sheet.triangles) mesh.add_triangle(t[0], t[1], t[2]);
  return mesh;
}

// Centroids of the sheet's triangles inside the body, with area vectors.
struct CrackArea {
  std::vector<Vec3> centre, normal2;  // m, m^2 (twice the area along the crack's normal)
};
inline CrackArea crack_area(const CrackSheet& sheet, const TriangleBvh& body) {
  CrackArea out;
  const SurfaceMesh mesh = mesh_of(sheet);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (body.inside(mesh.centroid(t)))
      out.centre.push_back(mesh.centroid(t)), out.normal2.push_back(mesh.area_normal2(t));
  return out;
}

// Where the crack crosses the surface: border edges between exited nodes, which lie a small overshoot outside of it.
inline std::vector<TraceEdge> trace(const CrackSheet& sheet) {
  std::vector<TraceEdge> out;
  for (const auto& loop : border_loops(sheet))
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      if (sheet.state[a] == NodeState::kExited && sheet.state[b] == NodeState::kExited)
        out.push_back({sheet.position[a], sheet.position[b]});
    }
  return out;
}

}  // namespace sherd
