// Sharp convex edges of a mesh against those of another: where two thin bodies cross edge on edge no sample of either
// lies near the other's surface.
#pragma once
#include <vector>

#include "engine/contact/distance_field.h"
#include "engine/contact/placement.h"

namespace sherd {

struct SharpEdge {
  Vec3 from, to;
  Vec3 inward[2];  // unit, at right angles to the edge, into its two faces: n is in its normal cone if n . inward <= 0
};

// Edges whose faces turn by more than 20 degrees outwards (others are round, and round parts meet at samples), in
// chunks of neighbours, each in a ball. Mesh coordinates, metres.
struct EdgeSet {
  struct Chunk {
    Vec3 centre;
    Real radius;
    std::uint32_t first, count;
  };
  std::vector<SharpEdge> edges;
  std::vector<Chunk> chunks;
};
EdgeSet sharp_edges(const SurfaceMesh& mesh);

struct EdgeCrossing {
  Vec3 point;     // middle between the two edges
  Vec3 normal;    // unit, from `other` to `own`
  Real distance;  // signed, negative when they have passed each other
};

// Pairs of edges of `own` (placed into the coordinates of `other`) and `other`, closest inside both, whose common
// perpendicular lies in both normal cones, nearer than `margin` and not passed by more than `depth`. The fields reject
// far chunks: `other_field` those of `own`, `own_field` those of `other`. In the coordinates of `other`.
void edge_crossings(const EdgeSet& own, const EdgeSet& other, const Placement& place,
                    const SignedDistanceField& own_field, const SignedDistanceField& other_field, Real margin,
                    Real depth, std::vector<EdgeCrossing>& found);

}  // namespace sherd
