// Mesh files into one welded mesh. The result is what the file holds, not yet a valid solid: repair_mesh() and
// report_mesh() come next.
#pragma once
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

enum class UpAxis { kY, kZ };  // the file's up axis; kZ turns (x, y, z) into (x, z, -y)

struct LoadOptions {
  Real scale = 1;  // metres per unit of the file, > 0
  UpAxis up = UpAxis::kY;
};

struct LoadLog {
  std::vector<std::string> messages;  // one sentence for everything changed or left out, with counts
  std::size_t file_triangles = 0;     // in the file, after triangulation: faces.source counts these
};

// Reads .obj, .off and .ply (in double precision) and .stl, .gltf, .glb, .3ds (in single precision, node transforms
// applied). All meshes of a file become one; polygons are triangulated; points and lines are left out. A mesh with
// borders gets vertices of equal coordinates joined, and border vertices closer than 1e-7 of the bounding box's
// diagonal joined where that closes borders. Triangles with a repeated vertex and copies of a triangle are dropped.
// Triangles without area between three vertices stay: dropping them would tear the surface (repair_mesh removes them).
// Texture coordinates become the corner channel "uv" (OBJ vt; PLY s and t, u and v or face lists `texcoord`; glTF,
// 3DS), other floating-point properties of a PLY's vertices or corners channels of their names; joined vertices keep
// their corners' own values. faces.source is the number of the file's triangle, counted after triangulation. InputError
// (file, place, remedy): missing, a folder, empty, unreadable, unknown ending, not what the ending says, truncated, an
// index out of range, a coordinate that is no finite number, no triangles.
SurfaceMesh load_mesh(const std::string& path, const LoadOptions& options, LoadLog& log);

}  // namespace sherd
