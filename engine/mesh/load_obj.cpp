// Wavefront OBJ: positions, texture coordinates and polygons; everything else (normals, groups, materials, lines) plays
// no role.
#include "engine/mesh/load_raw.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

class ObjReader {
 public:
  ObjReader(const std::string& path, const std::string& content) : path_(path), content_(content) {}

  SurfaceMesh read() {
    for (std::size_t at = 0; at < content_.size();) {
      const std::string line = next_line(at);
      std::size_t position = 0;
      const std::string_view keyword = next_token(line, position);
      if (keyword == "v")
        read_vertex(line, position);
      else if (keyword == "vt")
        read_texture(line, position);
      else if (keyword == "f")
        read_face(line, position);
    }
    // Positive indices may point to vertices listed later, so the range is known only here.
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      for (const std::uint32_t v : polygons_[i])
        if (v >= mesh_.vertex_count())
          fail(lines_[i], fmt::format("a face uses vertex {} of {}", std::size_t{v} + 1, mesh_.vertex_count()));
      add_textured(i);
    }
    if (textured_) mesh_.channels = {{"uv", 2, std::move(uv_)}};
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}; correct the line or export the file again", path_, line, what));
  }
  // One logical line: a backslash at the end continues it.
  std::string next_line(std::size_t& at) {
    std::string line;
    for (bool more = true; more && at < content_.size();) {
      const std::size_t end = std::min(content_.find('\n', at), content_.size());
      std::string_view part(content_.data() + at, end - at);
      at = end + 1, ++line_;
      if (!part.empty() && part.back() == '\r') part.remove_suffix(1);
      more = !part.empty() && part.back() == '\\';
      if (more) part.remove_suffix(1);
      line += part;
    }
    return line;
  }
  void read_vertex(const std::string& line, std::size_t position) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      const std::string_view token = next_token(line, position);
      if (!parse_number(token, p[k]))
        fail(line_, fmt::format("vertex {}: '{}' is no coordinate", mesh_.vertex_count() + 1, token));
      if (!std::isfinite(p[k]))
        fail(line_, fmt::format("vertex {} has a coordinate that is not finite ({})", mesh_.vertex_count() + 1, token));
    }
    mesh_.vertices.push_back(p);
  }
  void read_texture(const std::string& line, std::size_t position) {
    std::array<float, 2> uv{};
    for (float& x : uv) {
      const std::string_view token = next_token(line, position);
      double value = 0;
      if (token.empty() && &x != uv.data()) break;  // v is optional
      if (!parse_number(token, value) || !std::isfinite(value))
        fail(line_, fmt::format("texture coordinate {}: '{}' is no number", texture_.size() + 1, token));
      x = static_cast<float>(value);
    }
    texture_.push_back(uv);
  }
  // The number of the texture coordinate in "7/3/1", from 0; kNone when there is none.
  std::uint32_t texture_of(std::string_view token) const {
    const std::size_t slash = token.find('/');
    if (slash == std::string_view::npos) return kNone;
    const std::string_view text = token.substr(slash + 1, token.find('/', slash + 1) - slash - 1);
    if (text.empty()) return kNone;
    long long index = 0;
    if (!parse_number(text, index) || index == 0) fail(line_, fmt::format("'{}' has no texture coordinate", token));
    if (index < 0 && texture_.empty()) return kNone;
    if (index < 0) index += static_cast<long long>(texture_.size()) + 1;
    if (index < 1 || index > 0x7FFFFFFF)
      fail(line_, fmt::format("a face uses texture coordinate {} of {}", token, texture_.size()));
    return static_cast<std::uint32_t>(index - 1);
  }
  // Corners without a texture coordinate get (0, 0); a file may name texture coordinates and list none at all.
  void add_textured(std::size_t i) {
    for (const Triangle& t : triangulate_polygon(polygons_[i], mesh_)) {
      mesh_.add_triangle(polygons_[i][t[0]], polygons_[i][t[1]], polygons_[i][t[2]]);
      for (const std::uint32_t corner : t) {
        const std::uint32_t use = textures_[i][corner];
        if (use != kNone && use >= texture_.size() && !texture_.empty())
          fail(lines_[i],
               fmt::format("a face uses texture coordinate {} of {}", std::size_t{use} + 1, texture_.size()));
        const std::array<float, 2> uv = use < texture_.size() ? texture_[use] : std::array<float, 2>{};
        uv_.insert(uv_.end(), uv.begin(), uv.end());
        textured_ = textured_ || use < texture_.size();
      }
    }
  }
  void read_face(const std::string& line, std::size_t position) {
    std::vector<std::uint32_t> polygon, textures;
    for (std::string_view token = next_token(line, position); !token.empty() && token[0] != '#';
         token = next_token(line, position)) {
      long long index = 0;
      if (!parse_number(token.substr(0, token.find('/')), index) || index == 0)
        fail(line_, fmt::format("'{}' is no vertex of a face (they count from 1)", token));
      if (index < 0) index += static_cast<long long>(mesh_.vertex_count()) + 1;  // relative to the latest vertex
      if (index < 1 || index > 0x7FFFFFFF)
        fail(line_, fmt::format("a face uses vertex {} of {}", token, mesh_.vertex_count()));
      polygon.push_back(static_cast<std::uint32_t>(index - 1));
      textures.push_back(texture_of(token));
    }
    if (polygon.size() < 3) fail(line_, fmt::format("a face with {} vertices", polygon.size()));
    polygons_.push_back(std::move(polygon)), textures_.push_back(std::move(textures)), lines_.push_back(line_);
  }

  const std::string& path_;
  const std::string& content_;
  std::size_t line_ = 0;
  SurfaceMesh mesh_;
  std::vector<std::vector<std::uint32_t>> polygons_, textures_;  // vertices and texture coordinates of each corner
  std::vector<std::array<float, 2>> texture_;
  std::vector<float> uv_;
  bool textured_ = false;
  std::vector<std::size_t> lines_;
};

}  // namespace

SurfaceMesh read_obj(const std::string& path, const std::string& content) {
  return ObjReader(path, content).read();
}

}  // namespace sherd
