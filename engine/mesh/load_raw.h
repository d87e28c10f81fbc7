// Between the readers and load_mesh().
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

// Vertices and triangles as the file lists them (after triangulation); indices are in range.
SurfaceMesh read_ply(const std::string& path, const std::string& content);
SurfaceMesh read_obj(const std::string& path, const std::string& content);
SurfaceMesh read_off(const std::string& path, const std::string& content);
SurfaceMesh read_assimp(const std::string& path, std::vector<std::string>& messages);

// Throw InputError for files whose stated sizes do not fit their bytes.
void check_stl(const std::string& path, const std::string& content);
void check_gltf(const std::string& path, const std::string& content);
void check_glb(const std::string& path, const std::string& content);

// Parses a whole token; false when it is no number. "nan" and "inf" parse.
bool parse_number(std::string_view token, double& value);
bool parse_number(std::string_view token, long long& value);
// The next run of non-blank characters at or after `position`, which moves past it; empty at the end.
std::string_view next_token(std::string_view text, std::size_t& position);

// The polygon's triangles, as numbers of its own corners.
std::vector<Triangle> triangulate_polygon(const std::vector<std::uint32_t>& polygon, const SurfaceMesh& mesh);
// Adds the polygon's triangles.
void add_polygon(const std::vector<std::uint32_t>& polygon, SurfaceMesh& mesh);

// Joins vertices as load_mesh() describes; a sentence in `messages` for what was joined.
void weld(SurfaceMesh& mesh, std::vector<std::string>& messages);

}  // namespace sherd
