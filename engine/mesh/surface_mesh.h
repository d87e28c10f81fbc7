// The one mesh type: a triangle soup with shared vertices, structure of arrays. A *valid* mesh (engine/mesh/validate.h)
// is closed, 2-manifold, consistently oriented with outward normals, without degenerate triangles; every stage after
// loading expects that. Cavities are further components oriented into the cavity.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/core/column.h"

namespace sherd {

using Triangle = std::array<std::uint32_t, 3>;  // vertex indices, counter-clockwise seen from outside
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

enum class FaceKind : std::uint8_t { kOriginal = 0, kCrack = 1 };

// Cold per-face columns (fracture, render and export read them; the solver does not). Each has one entry per triangle.
struct FaceAttributes {
  std::vector<FaceKind> kind;
  std::vector<std::int32_t> crack;   // crack id of a kCrack face, -1 otherwise
  std::vector<std::int32_t> source;  // triangle of the input mesh an original face descends from, -1 otherwise
  std::vector<std::int8_t> side;     // of a kCrack face: +1 or -1 for the sheet's two walls, 0 for its rim; 0 otherwise
  std::vector<std::uint16_t> material;  // 0 outside, 1 on crack faces, unless the scene or the file says otherwise

  std::size_t size() const { return kind.size(); }
  void resize(std::size_t n) {
    kind.resize(n, FaceKind::kOriginal), crack.resize(n, -1), source.resize(n, -1), side.resize(n, 0),
        material.resize(n, 0);
  }
  void reserve(std::size_t n) {
    kind.reserve(n), crack.reserve(n), source.reserve(n), side.reserve(n), material.reserve(n);
  }
  void push_back_from(const FaceAttributes& other, std::size_t i) {
    kind.push_back(other.kind[i]), crack.push_back(other.crack[i]), source.push_back(other.source[i]),
        side.push_back(other.side[i]), material.push_back(other.material[i]);
  }
  friend bool operator==(const FaceAttributes&, const FaceAttributes&) = default;
};

// Values at the corners of triangles, so that they may jump across edges (texture seams). value[(3 t + k) * components
// + i] is component i at corner k of triangle t. Code that makes or drops faces keeps them (engine/mesh/attributes.h)
// or leaves out the channels altogether.
struct CornerChannel {
  std::string name;  // "uv", or the attribute's name in the file
  int components = 1;
  std::vector<float> value;

  std::size_t width() const { return 3 * static_cast<std::size_t>(components); }  // values per triangle
  friend bool operator==(const CornerChannel&, const CornerChannel&) = default;
};

struct SurfaceMesh {
  Vec3Column vertices;  // metres
  std::vector<Triangle> triangles;
  FaceAttributes faces;                 // same length as triangles
  std::vector<CornerChannel> channels;  // mostly none; each of width() * triangle_count() values

  std::size_t vertex_count() const { return vertices.size(); }
  std::size_t triangle_count() const { return triangles.size(); }
  Vec3 corner(std::size_t t, int k) const { return vertices[triangles[t][static_cast<std::size_t>(k)]]; }
  // Twice the area times the outward unit normal.
  Vec3 area_normal2(std::size_t t) const { return cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)); }
  Vec3 centroid(std::size_t t) const { return (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0; }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangles.push_back({a, b, c});
    faces.resize(triangles.size());
    for (CornerChannel& channel : channels) channel.value.resize(channel.width() * triangles.size(), 0);
  }
  friend bool operator==(const SurfaceMesh&, const SurfaceMesh&) = default;
};

struct Box {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void grow(const Vec3& p) { low = min(low, p), high = max(high, p); }
  void grow(const Box& b) { low = min(low, b.low), high = max(high, b.high); }
  bool overlaps(const Box& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y && low.z <= b.high.z &&
           b.low.z <= high.z;
  }
  Vec3 centre() const { return 0.5 * (low + high); }
  Real diagonal() const { return distance(low, high); }
};
Box bounding_box(const SurfaceMesh& mesh);
// Mean of all edge lengths (each triangle's three edges counted once per triangle), metres; 0 for an empty mesh.
Real mean_edge_length(const SurfaceMesh& mesh);
Real surface_area(const SurfaceMesh& mesh);
// Divergence theorem; positive when the normals point outward.
Real signed_volume(const SurfaceMesh& mesh);

// twin[3 t + k] is the directed edge opposite to edge k (corner k -> k+1) of triangle t, or kNone at a border.
// Edges used by other than two opposite directions stay kNone; validate() counts them.
std::vector<std::uint32_t> build_twins(const SurfaceMesh& mesh);
// Component label per triangle, connected over twins, numbered in order of first triangle; returns the number of
// components.
std::uint32_t label_components(const SurfaceMesh& mesh, std::vector<std::uint32_t>& label);

}  // namespace sherd
