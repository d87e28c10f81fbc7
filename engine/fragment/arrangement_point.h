// Points of the arrangement of two meshes: mesh vertices, and crossings of an edge uv with the plane of a triangle abc.
// Crossings are never constructed exactly in doubles; their defining coordinates are kept, so orientations of any three
// points of one face are decided exactly: rounded positions with error bounds first, expansions when those leave doubt.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/core/expansion.h"
#include "kernels/core/vec3.h"

namespace sherd {

struct ArrangementPoint {
  Vec3 position;      // rounded
  Real error = 0;     // bound of each coordinate's error; 0 for a vertex
  bool exact = true;  // a vertex: position is all; otherwise the crossing below
  Vec3 u, v;
  std::array<Vec3, 3> plane;
};

ArrangementPoint make_vertex(const Vec3& position);
// u and v lie strictly on opposite sides of the plane of the triangle.
ArrangementPoint make_crossing(const Vec3& u, const Vec3& v, const std::array<Vec3, 3>& plane);

// Orientation of points that lie exactly in one plane, seen against its normal (counter-clockwise positive), through
// the projection along the normal's largest component.
class PlanarOrientation {
 public:
  // corners: the face; points and edges must outlive this object. edges, when not empty: per point a bit for each edge
  // of the face that it is known to lie on exactly, which spares the exact arithmetic that would find that out.
  PlanarOrientation(const std::array<Vec3, 3>& corners, const std::vector<ArrangementPoint>& points,
                    const std::vector<std::uint8_t>& edges);
  bool degenerate() const { return sign_ == 0; }
  int operator()(std::uint32_t a, std::uint32_t b, std::uint32_t c);

 private:
  struct Homogeneous {
    Expansion x, y, w;  // w > 0
  };
  const Homogeneous& exact(std::uint32_t i);

  const std::vector<ArrangementPoint>& points_;
  const std::vector<std::uint8_t>& edges_;
  std::vector<std::optional<Homogeneous>> exact_;
  int first_ = 0, second_ = 1;  // the coordinates kept
  int sign_ = 0;
};

}  // namespace sherd
