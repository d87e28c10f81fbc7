// Guides as geometry. Internal to the fracture stage.
#pragma once
#include <optional>

#include "engine/fracture/guide.h"

namespace sherd {

// A line on (or near) the surface and the direction into the body.
struct GuideLine {
  std::vector<Vec3> points;
  Vec3 inward;  // unit
};
// The line in which a plane with a depth meets the tangent of the surface where that is nearest to the plane's point,
// across the whole body. Nothing when the plane runs along the surface there.
std::optional<GuideLine> surface_line(const GuidePlane& plane, const TriangleBvh& body);
// How far a wedge or curtain along a line drawn on the surface must stick out to clear the surface between its points.
Real overhang(const GuideLine& line, Real edge_length);

struct GuideShape {
  SurfaceMesh surface;  // open (or closed) triangle mesh; empty when there is nothing to follow
  Vec3 reference;       // where it should start
};
GuideShape guide_shape(const GuideSpec& spec, const TriangleBvh& body, Real edge_length);

// One seed for each curve in which the guide (whose triangles are `surface`) meets the body, in order of distance from
// `reference`; their stress has no value yet.
std::vector<CrackSeed> guide_seeds(const Guide& guide, const TriangleBvh& surface, const TriangleBvh& body,
                                   const SurfaceMesh& mesh, const Vec3& reference);

}  // namespace sherd
