// Minimal reader of the development meshes: binary little-endian PLY, float x y z, uchar-counted int triangles.
#pragma once
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "engine/mesh/surface_mesh.h"

namespace sherd::test {

// False when the file is absent (the meshes exist only in development).
inline bool read_shared_ply(const std::string& name, SurfaceMesh& mesh) {
  std::ifstream in(std::string(SHERD_SHARED) + "/meshes/" + name, std::ios::binary);
  if (!in) return false;
  mesh = {};
  std::size_t vertices = 0, faces = 0;
  for (std::string line; std::getline(in, line) && line != "end_header";) {
    std::istringstream words(line);
    std::string a, b;
    words >> a >> b;
    if (a == "element" && b == "vertex") words >> vertices;
    if (a == "element" && b == "face") words >> faces;
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    float p[3];
    in.read(reinterpret_cast<char*>(p), sizeof p);
    mesh.vertices.push_back({p[0], p[1], p[2]});
  }
  for (std::size_t i = 0; i < faces; ++i) {
    unsigned char count = 0;
    std::uint32_t t[3];
    in.read(reinterpret_cast<char*>(&count), 1);
    in.read(reinterpret_cast<char*>(t), sizeof t);
    if (!in || count != 3) return false;
    mesh.add_triangle(t[0], t[1], t[2]);
  }
  return true;
}

}  // namespace sherd::test
