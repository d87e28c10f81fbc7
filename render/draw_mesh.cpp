#include "render/draw_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace sherd {
namespace {

// Union-find over triangle corners; the smaller index is the root, so the result does not depend on the order of
// unions.
class CornerGroups {
 public:
  explicit CornerGroups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::uint32_t next_corner(std::uint32_t c) {
  return c % 3 == 2 ? c - 2 : c + 1;
}

FaceKind kind_of(const SurfaceMesh& mesh, std::size_t t) {
  return t < mesh.faces.kind.size() ? mesh.faces.kind[t] : FaceKind::kOriginal;
}

Real corner_angle(const SurfaceMesh& mesh, std::uint32_t corner) {
  const std::size_t t = corner / 3;
  const int k = static_cast<int>(corner % 3);
  const Vec3 p = mesh.corner(t, k), u = mesh.corner(t, (k + 1) % 3) - p, v = mesh.corner(t, (k + 2) % 3) - p;
  return std::atan2(norm(cross(u, v)), dot(u, v));
}

CornerGroups smooth_groups(const SurfaceMesh& mesh, const std::vector<Vec3>& normal, Real min_cosine) {
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  CornerGroups groups(twin.size());
  for (std::uint32_t edge = 0; edge < twin.size(); ++edge) {
    const std::uint32_t other = twin[edge];
    if (other == kNone || other < edge) continue;
    const std::uint32_t t = edge / 3, s = other / 3;
    if (kind_of(mesh, t) != kind_of(mesh, s) || dot(normal[t], normal[s]) < min_cosine) continue;
    groups.unite(edge, next_corner(other));  // opposite directions: the edge's start is the twin's end
    groups.unite(next_corner(edge), other);
  }
  return groups;
}

SurfaceMesh moved(const SurfaceMesh& mesh, const Vec3Column& by) {
  SurfaceMesh out = mesh;
  for (std::size_t v = 0; v < out.vertex_count(); ++v) out.vertices.set(v, out.vertices[v] + by[v]);
  return out;
}

DrawMesh make_at_rest(const SurfaceMesh& mesh, const std::vector<float>& value, Real crease_degrees) {
  DrawMesh out;
  const std::size_t n = mesh.triangle_count();
  out.box = bounding_box(mesh);
  out.origin = n == 0 ? Vec3{} : out.box.centre();
  std::vector<Vec3> normal(n);
  for (std::size_t t = 0; t < n; ++t) normal[t] = normalized(mesh.area_normal2(t));
  CornerGroups groups = smooth_groups(mesh, normal, std::cos(crease_degrees * std::numbers::pi / 180));

  std::vector<Vec3> sum(3 * n);
  for (std::uint32_t c = 0; c < 3 * n; ++c) sum[groups.root(c)] += corner_angle(mesh, c) * normal[c / 3];
  std::vector<float> total(value.size()), count(value.size());
  for (std::uint32_t c = 0; c < value.size(); ++c) total[groups.root(c)] += value[c], count[groups.root(c)] += 1;
  std::vector<std::uint32_t> vertex_of(3 * n, kNone);
  out.indices.reserve(3 * n);
  for (const FaceKind kind : {FaceKind::kOriginal, FaceKind::kCrack}) {
    for (std::uint32_t c = 0; c < 3 * n; ++c) {
      if (kind_of(mesh, c / 3) != kind) continue;
      const std::uint32_t root = groups.root(c);
      if (vertex_of[root] == kNone) {
        vertex_of[root] = static_cast<std::uint32_t>(out.vertices.size() / 6);
        const Vec3 p = mesh.corner(c / 3, static_cast<int>(c % 3)) - out.origin, m = normalized(sum[root]);
        for (const Real v : {p.x, p.y, p.z, m.x, m.y, m.z}) out.vertices.push_back(static_cast<float>(v));
        if (!value.empty()) out.values.push_back(total[root] / count[root]);
      }
      out.indices.push_back(vertex_of[root]);
    }
    if (kind == FaceKind::kOriginal) out.original_indices = out.indices.size();
  }
  return out;
}

}  // namespace

DrawMesh make_draw_mesh(const SurfaceMesh& mesh, const SurfaceField* field, Real crease_degrees) {
  static const std::vector<float> kNoValues;
  const std::vector<float>& value = field ? field->value : kNoValues;
  if (!field || field->displacement.size() == 0) return make_at_rest(mesh, value, crease_degrees);
  return make_at_rest(moved(mesh, field->displacement), value, crease_degrees);
}

}  // namespace sherd
