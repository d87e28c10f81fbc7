// Wavefront OBJ: positions and polygons; everything else (normals, textures, groups, materials, lines) plays no role.
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
      else if (keyword == "f")
        read_face(line, position);
    }
    // Positive indices may point to vertices listed later, so the range is known only here.
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      for (const std::uint32_t v : polygons_[i])
        if (v >= mesh_.vertex_count())
          fail(lines_[i], fmt::format("a face uses vertex {} of {}", std::size_t{v} + 1, mesh_.vertex_count()));
      add_polygon(polygons_[i], mesh_);
    }
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
  void read_face(const std::string& line, std::size_t position) {
    std::vector<std::uint32_t> polygon;
    for (std::string_view token = next_token(line, position); !token.empty() && token[0] != '#';
         token = next_token(line, position)) {
      long long index = 0;
      if (!parse_number(token.substr(0, token.find('/')), index) || index == 0)
        fail(line_, fmt::format("'{}' is no vertex of a face (they count from 1)", token));
      if (index < 0) index += static_cast<long long>(mesh_.vertex_count()) + 1;  // relative to the latest vertex
      if (index < 1 || index > 0x7FFFFFFF)
        fail(line_, fmt::format("a face uses vertex {} of {}", token, mesh_.vertex_count()));
      polygon.push_back(static_cast<std::uint32_t>(index - 1));
    }
    if (polygon.size() < 3) fail(line_, fmt::format("a face with {} vertices", polygon.size()));
    polygons_.push_back(std::move(polygon)), lines_.push_back(line_);
  }

  const std::string& path_;
  const std::string& content_;
  std::size_t line_ = 0;
  SurfaceMesh mesh_;
  std::vector<std::vector<std::uint32_t>> polygons_;
  std::vector<std::size_t> lines_;
};

}  // namespace

SurfaceMesh read_obj(const std::string& path, const std::string& content) {
  return ObjReader(path, content).read();
}

}  // namespace sherd
