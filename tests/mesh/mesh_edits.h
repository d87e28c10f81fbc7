// Small changes to meshes that several tests make.
#pragma once
#include <utility>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

// Both meshes in one, b moved by `shift` (m).
inline SurfaceMesh joined(SurfaceMesh a, const SurfaceMesh& b, const Vec3& shift = {}) {
  const auto offset = static_cast<std::uint32_t>(a.vertex_count());
  for (std::size_t i = 0; i < b.vertex_count(); ++i) a.vertices.push_back(b.vertices[i] + shift);
  for (const Triangle& t : b.triangles) a.add_triangle(offset + t[0], offset + t[1], offset + t[2]);
  return a;
}

// Every triangle turned over.
inline SurfaceMesh flipped(SurfaceMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace sherd
