// Mesh files. Bytes depend on the mesh alone. A file is written under a temporary name beside its final one and renamed
// when complete, so a half-written mesh never bears the final name. InputError names the file when it cannot be
// written.
#pragma once
#include <string>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

enum class PlyPrecision { kFloat, kDouble };

// Binary little-endian PLY. When any face is a crack face, each face also has `uchar kind` (0 original, 1 crack),
// `int crack`, `int source`, `char side` and `ushort material` (FaceAttributes). Corner channels are
// lists of floats of each face, the values of its corners one after the other: "uv" as `texcoord`, others under their
// own names. load_mesh() reads the channels back.
void write_ply(const SurfaceMesh& mesh, const std::string& path, PlyPrecision precision = PlyPrecision::kFloat);
// Wavefront OBJ with 17 significant digits (doubles survive), texture coordinates of the channel "uv" (no other
// channel); crack faces are in the group "crack", others in "original".
void write_obj(const SurfaceMesh& mesh, const std::string& path);

}  // namespace sherd
