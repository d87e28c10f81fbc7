// How the material space of one body lies in that of another.
#pragma once
#include "engine/body/body.h"

namespace sherd {

// y = rotation x + shift, rotation orthogonal.
struct Placement {
  Mat3 rotation;
  Vec3 shift;

  Vec3 operator()(const Vec3& x) const { return rotation * x + shift; }
};

inline Placement placement(const Body& from, const Body& to) {
  const Mat3 a = to_matrix(from.pose.orientation), bt = transpose(to_matrix(to.pose.orientation));
  return {bt * a, bt * (from.pose.position - a * from.mass.centre - to.pose.position) + to.mass.centre};
}
inline Placement inverse(const Placement& p) {
  const Mat3 back = transpose(p.rotation);
  return {back, -(back * p.shift)};
}

}  // namespace sherd
