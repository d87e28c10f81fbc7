#include <algorithm>
#include <cmath>

#include "engine/fracture/guide.h"
#include "engine/fracture/guide_shape.h"

namespace sherd {
namespace {

// The line with points at most an edge apart, its own points kept.
std::vector<Vec3> divided(const std::vector<Vec3>& points, Real edge) {
  std::vector<Vec3> fine{points.front()};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const int parts = std::max(1, static_cast<int>(std::ceil(distance(points[i], points[i + 1]) / edge)));
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

}  // namespace

std::optional<SurfaceMesh> notch_wedge(const NotchSpec& notch, const TriangleBvh& body, Real width, Real edge_length) {
  GuideLine line;
  Real depth = 0;
  if (const auto* plane = std::get_if<GuidePlane>(&notch)) {
    const std::optional<GuideLine> found = surface_line(*plane, body);
    if (!found) return std::nullopt;
    line = {{found->points.front(), found->points.back()}, found->inward}, depth = plane->depth;
  } else {
    const GuidePolyline& drawn = std::get<GuidePolyline>(notch);
    line = {drawn.points, drawn.inward}, depth = drawn.depth;
  }
  // A plane's line touches the surface, a drawn one may run below it between its points.
  const Real over = line.points.size() == 2 && std::holds_alternative<GuidePlane>(notch) ? 2 * edge_length
                                                                                         : overhang(line, edge_length);
  const std::vector<Vec3> points = divided(line.points, edge_length);
  const int rows = std::max(1, static_cast<int>(std::ceil(depth / edge_length)));
  // A cross-section: left and right wall from the top (row 0, outside) over the surface (row 1) to the shared tip.
  SurfaceMesh wedge;
  const auto sections = static_cast<std::uint32_t>(points.size()), tip = static_cast<std::uint32_t>(2 * rows + 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 side = side_at(points, i, line.inward, 0.5 * width);
    for (int row = 0; row <= rows; ++row) {
      const Real share = row == 0 ? 0 : Real(row - 1) / rows, at = row == 0 ? -over : share * depth;
      wedge.vertices.push_back(points[i] + at * line.inward - (1 - share) * side);
      wedge.vertices.push_back(points[i] + at * line.inward + (1 - share) * side);
    }
    wedge.vertices.push_back(points[i] + depth * line.inward);
  }
  const auto left = [&](std::uint32_t i, int row) {
    return row > rows ? i * (tip + 1) + tip : i * (tip + 1) + 2 * static_cast<std::uint32_t>(row);
  };
  const auto right = [&](std::uint32_t i, int row) { return row > rows ? left(i, row) : left(i, row) + 1; };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    wedge.add_triangle(a, b, c);
    if (c != d) wedge.add_triangle(a, c, d);
  };
  for (std::uint32_t i = 0; i + 1 < sections; ++i) {
    quad(left(i, 0), right(i, 0), right(i + 1, 0), left(i + 1, 0));
    for (int row = 0; row <= rows; ++row) {
      quad(left(i, row), left(i + 1, row), left(i + 1, row + 1), left(i, row + 1));
      quad(right(i, row), right(i, row + 1), right(i + 1, row + 1), right(i + 1, row));
    }
  }
  for (int row = 0; row <= rows; ++row) {
    const std::uint32_t last = sections - 1;
    quad(right(0, row), left(0, row), left(0, row + 1), right(0, row + 1));
    quad(left(last, row), right(last, row), right(last, row + 1), left(last, row + 1));
  }
  if (signed_volume(wedge) < 0)
    for (Triangle& t : wedge.triangles) std::swap(t[1], t[2]);
  wedge.faces.resize(wedge.triangle_count());
  return wedge;
}

}  // namespace sherd
