#include "engine/mesh/load.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/mesh/attributes.h"
#include "engine/mesh/load_raw.h"
#include "engine/mesh/repair_loop.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr Real kLargestCoordinate = 1e9;  // metres; beyond, a file's own rounding is coarser than any object here

std::string lower_ending(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return ending;
}

std::string read_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(fmt::format("{}: no such mesh file; check the name", path));
  if (std::filesystem::is_directory(status))
    throw InputError(fmt::format("{}: is a folder; name a mesh file in it", path));
  if (!std::filesystem::is_regular_file(status)) throw InputError(fmt::format("{}: is not a regular file", path));
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (file && std::filesystem::file_size(path, error) > 0) content << file.rdbuf();
  if (!file || file.bad() || error) throw InputError(fmt::format("{}: cannot be read; check its permissions", path));
  std::string text = std::move(content).str();
  if (text.empty()) throw InputError(fmt::format("{}: the file is empty (0 bytes); export it again", path));
  return text;
}

SurfaceMesh read_any(const std::string& path, std::vector<std::string>& messages) {
  const std::string ending = lower_ending(path);
  const char* const known[] = {".obj", ".off", ".ply", ".stl", ".gltf", ".glb", ".3ds"};
  const std::string content = read_file(path);
  if (std::none_of(std::begin(known), std::end(known), [&](const char* e) { return ending == e; }))
    throw InputError(fmt::format("{}: unknown ending '{}'; convert it to .obj, .off, .ply, .stl, .gltf, .glb or .3ds",
                                 path, ending));
  if (ending == ".obj") return read_obj(path, content);
  if (ending == ".off") return read_off(path, content);
  if (ending == ".ply") return read_ply(path, content);
  if (ending == ".stl") check_stl(path, content);
  if (ending == ".gltf") check_gltf(path, content);
  if (ending == ".glb") check_glb(path, content);
  return read_assimp(path, messages);
}

void place(const std::string& path, SurfaceMesh& mesh, const LoadOptions& options) {
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3 p = options.scale * mesh.vertices[i];
    mesh.vertices.set(i, options.up == UpAxis::kZ ? Vec3{p.x, p.z, -p.y} : p);
  }
  const Box box = bounding_box(mesh);
  const Vec3 far = max(box.high, -box.low);
  if (!(std::max({far.x, far.y, far.z}) < kLargestCoordinate))
    throw InputError(fmt::format("{}: coordinates reach {:.3g} m with scale {}; check the scale", path,
                                 std::max({far.x, far.y, far.z}), options.scale));
}

void drop_useless_triangles(SurfaceMesh& mesh, std::vector<std::string>& messages) {
  std::vector<bool> keep(mesh.triangle_count(), true);
  std::vector<std::pair<Triangle, std::size_t>> turned;  // smallest index first, orientation kept
  std::size_t repeated = 0, copies = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Triangle f = mesh.triangles[t];
    if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) {
      keep[t] = false, ++repeated;
      continue;
    }
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    turned.emplace_back(f, t);
  }
  std::sort(turned.begin(), turned.end());
  for (std::size_t i = 1; i < turned.size(); ++i)
    if (turned[i].first == turned[i - 1].first) keep[turned[i].second] = false, ++copies;
  if (repeated > 0) messages.push_back(fmt::format("dropped {} triangles with a repeated vertex", repeated));
  if (copies > 0) messages.push_back(fmt::format("dropped {} copies of triangles", copies));
  if (repeated + copies > 0) keep_faces(mesh, keep);
}

}  // namespace

std::string_view next_token(std::string_view text, std::size_t& position) {
  constexpr std::string_view kBlank = " \t\r\n\v\f";
  const std::size_t begin = std::min(text.find_first_not_of(kBlank, position), text.size());
  const std::size_t end = std::min(text.find_first_of(kBlank, begin), text.size());
  position = end;
  return text.substr(begin, end - begin);
}

namespace {
template <class T>
bool parse_any(std::string_view token, T& value) {
  if (!token.empty() && token[0] == '+') token.remove_prefix(1);
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  return error == std::errc() && end == token.data() + token.size() && !token.empty();
}
}  // namespace

bool parse_number(std::string_view token, double& value) {
  return parse_any(token, value);
}
bool parse_number(std::string_view token, long long& value) {
  return parse_any(token, value);
}

std::vector<Triangle> triangulate_polygon(const std::vector<std::uint32_t>& polygon, const SurfaceMesh& mesh) {
  if (polygon.size() == 3) return {{0, 1, 2}};
  std::vector<Vec3> loop;
  for (const std::uint32_t v : polygon) loop.push_back(mesh.vertices[v]);
  return triangulate_loop(loop);
}

void add_polygon(const std::vector<std::uint32_t>& polygon, SurfaceMesh& mesh) {
  for (const Triangle& t : triangulate_polygon(polygon, mesh))
    mesh.add_triangle(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
}

SurfaceMesh load_mesh(const std::string& path, const LoadOptions& options, LoadLog& log) {
  if (!(options.scale > 0) || !std::isfinite(options.scale))
    throw InputError(fmt::format("{}: the mesh's scale must be positive, got {}", path, options.scale));
  SurfaceMesh mesh = read_any(path, log.messages);
  if (mesh.triangles.empty())
    throw InputError(fmt::format("{}: the file has no triangles; export a triangle mesh", path));
  log.file_triangles = mesh.triangle_count();
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) mesh.faces.source[t] = static_cast<std::int32_t>(t);
  place(path, mesh, options);
  weld(mesh, log.messages);
  drop_useless_triangles(mesh, log.messages);
  if (mesh.triangles.empty())
    throw InputError(fmt::format("{}: no triangle of the file has an area; export it again", path));
  return mesh;
}

}  // namespace sherd
