#include "engine/mesh/shapes.h"

#include <algorithm>
#include <map>

#include "engine/mesh/shapes_revolve.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

using Lattice = std::array<int, 3>;

// One side of the box: corner lattice point, two in-plane axes u, v with u x v outward.
struct Side {
  int u, v, w;
  bool high;
};

void add_side(const Side& side, const Lattice& n, const Vec3& size, std::map<Lattice, std::uint32_t>& ids,
              SurfaceMesh& mesh) {
  const auto vertex = [&](int i, int j) {
    Lattice at{};
    at[static_cast<std::size_t>(side.u)] = i, at[static_cast<std::size_t>(side.v)] = j;
    at[static_cast<std::size_t>(side.w)] = side.high ? n[static_cast<std::size_t>(side.w)] : 0;
    const auto [slot, fresh] = ids.try_emplace(at, static_cast<std::uint32_t>(mesh.vertex_count()));
    if (fresh) {
      Vec3 p;
      for (int a = 0; a < 3; ++a) {
        const int k = at[static_cast<std::size_t>(a)], m = n[static_cast<std::size_t>(a)];
        p[a] = size[a] * (static_cast<Real>(2 * k - m) / static_cast<Real>(2 * m));  // exactly symmetric about 0
      }
      mesh.vertices.push_back(p);
    }
    return slot->second;
  };
  for (int j = 0; j < n[static_cast<std::size_t>(side.v)]; ++j)
    for (int i = 0; i < n[static_cast<std::size_t>(side.u)]; ++i) {
      const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
      // Alternating diagonals keep the mirror symmetries of the box when the counts are even.
      if ((i + j) % 2 == 0)
        mesh.add_triangle(a, b, c), mesh.add_triangle(a, c, d);
      else
        mesh.add_triangle(a, b, d), mesh.add_triangle(b, c, d);
    }
}

SurfaceMesh icosahedron() {
  const Real g = 0.5 * (1 + std::sqrt(5.0));
  SurfaceMesh m;
  for (const Vec3& p :
       {Vec3{-1, g, 0}, Vec3{1, g, 0}, Vec3{-1, -g, 0}, Vec3{1, -g, 0}, Vec3{0, -1, g}, Vec3{0, 1, g}, Vec3{0, -1, -g},
        Vec3{0, 1, -g}, Vec3{g, 0, -1}, Vec3{g, 0, 1}, Vec3{-g, 0, -1}, Vec3{-g, 0, 1}})
    m.vertices.push_back(normalized(p));
  m.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return m;
}

// Vertices of the subdivided icosahedron, shared over its 12 corners and 30 edges.
class IcosphereBuilder {
 public:
  IcosphereBuilder(Real radius, int frequency) : radius_(radius), f_(frequency), base_(icosahedron()) {
    for (std::size_t i = 0; i < 12; ++i) mesh_.vertices.push_back(radius_ * base_.vertices[i]);
  }
  SurfaceMesh build() {
    for (const Triangle& t : base_.triangles) add_face(t);
    return std::move(mesh_);
  }

 private:
  std::uint32_t add(const Vec3& p) {
    mesh_.vertices.push_back(radius_ * normalized(p));
    return static_cast<std::uint32_t>(mesh_.vertex_count() - 1);
  }
  std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, int k) {  // k parts of f from a to b, 0 < k < f
    if (a > b) return on_edge(b, a, f_ - k);
    const auto [slot, fresh] = edges_.try_emplace({a, b});
    if (fresh)
      for (int i = 1; i < f_; ++i)
        slot->second.push_back(
            add(static_cast<Real>(f_ - i) * base_.vertices[a] + static_cast<Real>(i) * base_.vertices[b]));
    return slot->second[static_cast<std::size_t>(k - 1)];
  }
  std::uint32_t vertex(const Triangle& t, int i, int j) {  // i parts towards corner 1, j towards corner 2
    const int h = f_ - i - j;
    if (h == f_) return t[0];
    if (i == f_) return t[1];
    if (j == f_) return t[2];
    if (j == 0) return on_edge(t[0], t[1], i);
    if (i == 0) return on_edge(t[0], t[2], j);
    if (h == 0) return on_edge(t[1], t[2], j);
    return add(static_cast<Real>(h) * base_.vertices[t[0]] + static_cast<Real>(i) * base_.vertices[t[1]] +
               static_cast<Real>(j) * base_.vertices[t[2]]);
  }
  void add_face(const Triangle& t) {
    std::vector<std::uint32_t> row, next;
    for (int i = 0; i <= f_; ++i) row.push_back(vertex(t, i, 0));
    for (int j = 0; j < f_; ++j) {
      next.clear();
      for (int i = 0; i <= f_ - j - 1; ++i) next.push_back(vertex(t, i, j + 1));
      for (std::size_t i = 0; i + 1 < row.size(); ++i) {
        mesh_.add_triangle(row[i], row[i + 1], next[i]);
        if (i + 1 < next.size()) mesh_.add_triangle(row[i + 1], next[i + 1], next[i]);
      }
      row.swap(next);
    }
  }

  Real radius_;
  int f_;
  SurfaceMesh base_, mesh_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges_;
};

}  // namespace

void require_shape(bool good, const std::string& text) {
  if (!good) throw InputError(fmt::format("generated shape: {}", text));
}

void require_size(const char* shape, const char* name, Real value) {
  require_shape(std::isfinite(value) && value > 0, fmt::format("{}: {} must be positive, got {}", shape, name, value));
}

void require_affordable(const char* shape, Real area, Real edge) {
  const Real triangles = area / (0.4 * edge * edge);
  require_shape(triangles < 2e7, fmt::format("{}: an edge of {} m needs about {:.3g} triangles; use a longer edge",
                                             shape, edge, triangles));
}

SurfaceMesh make_box(const Vec3& size, Real edge) {
  require_size("box", "edge", edge);
  for (int a = 0; a < 3; ++a) require_size("box", "size", size[a]);
  require_affordable("box", 2 * (size.x * size.y + size.y * size.z + size.z * size.x), edge);
  Lattice n;
  for (int a = 0; a < 3; ++a) {
    require_shape(size[a] / edge < 1e7,
                  fmt::format("box: an edge of {} m is too short for a side of {} m", edge, size[a]));
    n[static_cast<std::size_t>(a)] = std::max(1, static_cast<int>(std::lround(size[a] / edge)));
  }
  SurfaceMesh mesh;
  std::map<Lattice, std::uint32_t> ids;
  for (const Side& s : {Side{1, 2, 0, true}, Side{2, 1, 0, false}, Side{2, 0, 1, true}, Side{0, 2, 1, false},
                        Side{0, 1, 2, true}, Side{1, 0, 2, false}})
    add_side(s, n, size, ids, mesh);
  return mesh;
}

SurfaceMesh make_plate(Real width, Real depth, Real thickness, Real edge) {
  return make_box({width, thickness, depth}, edge);
}

SurfaceMesh make_bar(Real length, Real height, Real width, Real edge) {
  return make_box({length, height, width}, edge);
}

SurfaceMesh make_sphere(Real radius, Real edge) {
  require_size("sphere", "radius", radius);
  require_size("sphere", "edge", edge);
  const Real pi = 3.14159265358979323846;
  require_affordable("sphere", 4 * pi * radius * radius, edge);
  // 20 f^2 equilateral triangles of side `edge` cover 4 pi r^2.
  const Real frequency = std::sqrt(4 * pi / (5 * std::sqrt(3.0))) * radius / edge;
  return IcosphereBuilder(radius, std::max(1, static_cast<int>(std::lround(frequency)))).build();
}

SurfaceMesh make_hollow_sphere(Real outer, Real inner, Real edge) {
  SurfaceMesh mesh = make_sphere(outer, edge);
  const SurfaceMesh cavity = make_sphere(inner, edge);
  // The outer polyhedron's nearest face must stay outside the cavity's vertices.
  Real nearest = outer;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    nearest = std::min(nearest, dot(mesh.corner(t, 0), normalized(mesh.area_normal2(t))));
  require_shape(inner < nearest,
                fmt::format("hollow sphere: inner radius {} must be below {} (the outer radius {} less the "
                            "facets' depth); make the wall thicker or the edge shorter",
                            inner, nearest, outer));
  const auto offset = static_cast<std::uint32_t>(mesh.vertex_count());
  for (std::size_t i = 0; i < cavity.vertex_count(); ++i) mesh.vertices.push_back(cavity.vertices[i]);
  for (const Triangle& t : cavity.triangles) mesh.add_triangle(offset + t[0], offset + t[2], offset + t[1]);
  return mesh;
}

}  // namespace sherd
