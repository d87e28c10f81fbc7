// The trace of a crack on a cylinder about the y axis.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/core/vec3.h"

namespace sherd {

struct TraceEdge {
  Vec3 from, to;
};

// Of a crack's trace on a cylinder about y, |y| <= `until`: length-weighted mean of the signed angle between its edges
// and the axis in the unrolled surface, positive where it turns with growing y like a right-handed screw.
struct Helix {
  Real angle = 0, length = 0, reach = 0;  // radians, m, largest |y|
};
inline Helix helix(const std::vector<TraceEdge>& edges, Real until) {
  Helix h;
  for (const TraceEdge& e : edges) {
    const Vec3 middle = 0.5 * (e.from + e.to);
    h.reach = std::max(h.reach, std::abs(middle.y));
    if (std::abs(middle.y) > until) continue;
    const Vec3 axis{0, 1, 0}, radial = normalized(Vec3{middle.x, 0, middle.z}), around = cross(axis, radial);
    const Vec3 way = e.to - e.from;
    Real along = way.y, across = dot(way, around);
    if (along < 0) along = -along, across = -across;
    const Real length = std::hypot(along, across);
    h.angle += length * std::atan2(across, along), h.length += length;
  }
  h.angle /= std::max(h.length, 1e-300);
  return h;
}

}  // namespace sherd
