// Shared by the generated shapes: input checks, and solids of revolution from a profile in the (r, y) half plane.
#pragma once
#include <functional>
#include <string>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

void require_shape(bool good, const std::string& text);              // InputError with `text`
void require_size(const char* shape, const char* name, Real value);  // positive and finite
void require_affordable(const char* shape, Real area, Real edge);    // at most 20 million triangles

struct ProfilePoint {
  Real r, y;
};
using ProfileCurve = std::function<ProfilePoint(Real)>;  // parameter in [0, 1]

// A counter-clockwise profile (outward = right of the direction of travel), with the wanted edge around each ring.
struct Profile {
  std::vector<ProfilePoint> points;
  std::vector<Real> edge;
  bool closed = false;  // a ring about the axis (torus); else the first and the last point lie on the axis

  // Appends `curve` in pieces of equal length near `target`, at least `least` of them; its first point only when
  // nothing was added before (sections share their end points).
  void add(const ProfileCurve& curve, Real target, int least = 1);
  void add_line(ProfilePoint a, ProfilePoint b, Real target, int least = 1);
  // Arc about c, from angle a0 to a1 (radians, 0 = +r, counter-clockwise).
  void add_arc(ProfilePoint c, Real radius, Real a0, Real a1, Real target, int least);
};

// Each ring has round(2 pi r / edge) segments, at least `least` (rings inside the first edge length from the axis: 6),
// and rings of different counts are stitched, so triangles keep their shape towards the axis.
SurfaceMesh revolve(const Profile& profile, int least = 8);

}  // namespace sherd
