#include <algorithm>
#include <cmath>

#include "engine/fracture/guide.h"
#include "engine/fracture/guide_shape.h"

namespace sherd {
namespace {

// How many parts of about an edge a length is divided into. The cut divides faces further where it must, so the bound
// only keeps a slip of unit in a scene from filling the memory.
int part_count(Real length, Real edge) {
  constexpr Real kMost = 500;
  return static_cast<int>(std::clamp(std::ceil(length / edge), 1.0, kMost));
}

// The line with points about an edge apart, its own points kept.
std::vector<Vec3> divided(const std::vector<Vec3>& points, Real edge) {
  std::vector<Vec3> fine{points.front()};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const int parts = part_count(distance(points[i], points[i + 1]), edge);
    for (int k = 1; k <= parts; ++k) fine.push_back(points[i] + Real(k) / parts * (points[i + 1] - points[i]));
  }
  return fine;
}

// Half the wedge's width along the line's side direction at point i, mitred so that both walls stay `half` from it.
Vec3 side_at(const std::vector<Vec3>& points, std::size_t i, const Vec3& inward, Real half) {
  const auto side = [&](std::size_t a) { return normalized(cross(inward, points[a + 1] - points[a])); };
  const Vec3 before = side(i == 0 ? 0 : i - 1), after = side(std::min(i, points.size() - 2));
  const Vec3 mean = normalized(before + after);
  constexpr Real kLeastCosine = 0.3;  // of half the bend: sharper ones are cut off
  return half / std::max(kLeastCosine, dot(mean, after)) * mean;
}

// A wedge as a row of cross-sections: left and right wall from the top (row 0, outside the body) over the surface (row
// 1) to the tip they share.
class WedgeBuilder {
 public:
  explicit WedgeBuilder(int rows) : rows_(rows), stride_(static_cast<std::uint32_t>(2 * rows + 3)) {}

  // At a point of the line; `side` is half the width at the surface.
  void add_section(const Vec3& point, const Vec3& inward, const Vec3& side, Real over, Real depth) {
    for (int row = 0; row <= rows_; ++row) {
      const Real share = row == 0 ? 0 : Real(row - 1) / rows_;
      const Vec3 middle = point + (row == 0 ? -over : share * depth) * inward;
      mesh_.vertices.push_back(middle - (1 - share) * side);
      mesh_.vertices.push_back(middle + (1 - share) * side);
    }
    mesh_.vertices.push_back(point + depth * inward);
    ++sections_;
  }

  // Outward where side = inward x the line's direction.
  SurfaceMesh close() && {
    for (std::uint32_t i = 0; i + 1 < sections_; ++i) {
      quad(left(i, 0), right(i, 0), right(i + 1, 0), left(i + 1, 0));
      for (int row = 0; row <= rows_; ++row) {
        quad(left(i, row), left(i + 1, row), left(i + 1, row + 1), left(i, row + 1));
        quad(right(i, row), right(i, row + 1), right(i + 1, row + 1), right(i + 1, row));
      }
    }
    const std::uint32_t last = sections_ - 1;
    for (int row = 0; row <= rows_; ++row) {
      quad(right(0, row), left(0, row), left(0, row + 1), right(0, row + 1));
      quad(left(last, row), right(last, row), right(last, row + 1), left(last, row + 1));
    }
    return std::move(mesh_);
  }

 private:
  std::uint32_t left(std::uint32_t section, int row) const {
    return section * stride_ + (row > rows_ ? stride_ - 1 : 2 * static_cast<std::uint32_t>(row));
  }
  std::uint32_t right(std::uint32_t section, int row) const { return left(section, row) + (row > rows_ ? 0 : 1); }
  // A triangle where c and d are the tip.
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh_.add_triangle(a, b, c);
    if (c != d) mesh_.add_triangle(a, c, d);
  }

  int rows_;
  std::uint32_t stride_, sections_ = 0;
  SurfaceMesh mesh_;
};

}  // namespace

std::optional<SurfaceMesh> notch_wedge(const NotchSpec& notch, const TriangleBvh& body, Real width, Real edge_length) {
  GuideLine line;
  Real depth = 0, over = 2 * edge_length;
  if (const auto* plane = std::get_if<GuidePlane>(&notch)) {
    const std::optional<GuideLine> found = surface_line(*plane, body);
    if (!found) return std::nullopt;
    line = *found, depth = plane->depth;
  } else {
    const GuidePolyline& drawn = std::get<GuidePolyline>(notch);
    line = {drawn.points, drawn.inward}, depth = drawn.depth;
    over = overhang(line, edge_length);
  }
  const std::vector<Vec3> points = divided(line.points, edge_length);
  WedgeBuilder wedge(part_count(depth, edge_length));
  for (std::size_t i = 0; i < points.size(); ++i)
    wedge.add_section(points[i], line.inward, side_at(points, i, line.inward, 0.5 * width), over, depth);
  return std::move(wedge).close();
}

}  // namespace sherd
