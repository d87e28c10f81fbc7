// What narrow-phase detection needs of one mesh: samples of its surface (the point shell), its sharp edges, and its
// signed distance, once on a grid to reject points fast and once exactly for the few that remain. All in mesh
// (material) coordinates, metres.
#pragma once
#include <memory>

#include "engine/contact/distance_field.h"
#include "engine/contact/edges.h"

namespace sherd {

// Surface samples with unit outward normals: every vertex, and on edges and triangles long against `spacing` points
// between. Samples lie in chunks of neighbours, each in a ball, so that far parts are skipped at once.
struct PointShell {
  struct Chunk {
    Vec3 centre;
    Real radius;
    std::uint32_t first, count;
  };
  Vec3Column points, normals;
  std::vector<Chunk> chunks;
};

// Outward pseudo-normals (unit): angle-weighted at vertices, sum of the two faces' at edges (indexed like build_twins).
// The sign of (p - closest) . normal at the closest feature is the side of p, exactly, for a closed embedded mesh
// (Baerentzen and Aanaes 2005).
struct PseudoNormals {
  std::vector<Vec3> face, edge, vertex;
};
PseudoNormals pseudo_normals(const SurfaceMesh& mesh);
PointShell point_shell(const SurfaceMesh& mesh, const PseudoNormals& normals, Real spacing);

class CollisionShape {
 public:
  explicit CollisionShape(std::shared_ptr<const SurfaceMesh> mesh, const FieldOptions& options = {});

  struct Nearest {
    Vec3 point;          // on the surface
    Vec3 normal;         // unit, outward: direction of steepest distance, the pseudo-normal on the surface itself
    Real distance = 0;   // signed, negative inside
    bool found = false;  // false when nothing lies within the given distance
  };
  Nearest nearest(const Vec3& p, Real max_distance) const;
  const SignedDistanceField& field() const { return field_; }
  const PointShell& shell() const { return shell_; }
  const EdgeSet& edges() const { return edges_; }

 private:
  std::shared_ptr<const SurfaceMesh> mesh_;
  TriangleBvh bvh_;
  PseudoNormals normals_;
  SignedDistanceField field_;
  PointShell shell_;
  EdgeSet edges_;
};

// Signed distance of two bodies at poses that `place` relates (material of `own` to that of `other`): of the nearest
// samples either way and crossing edges; `limit` when it is that or more. Less than the true distance by no more than
// what curved or rough parts bulge between samples.
Real gap_between(const CollisionShape& own, const CollisionShape& other, const Placement& place, Real limit);

}  // namespace sherd
