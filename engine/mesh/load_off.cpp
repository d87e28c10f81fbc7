// OFF, ascii: the counts, vertices (x, y, z; further numbers of a line play no role), polygons with optional colours.
#include "engine/mesh/load_raw.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

class OffReader {
 public:
  OffReader(const std::string& path, const std::string& content) : path_(path), content_(content) {}

  SurfaceMesh read() {
    std::string_view line = data_line("the counts");
    std::size_t position = 0;
    const std::string_view magic = next_token(line, position);
    // Prefixes announce further numbers after the coordinates: colours, normals, texture coordinates.
    if (magic != "OFF" && magic != "COFF" && magic != "NOFF" && magic != "CNOFF" && magic != "STOFF")
      fail("the first line is not 'OFF' (binary and n-dimensional files are not read)");
    std::string_view token = next_token(line, position);
    if (token.empty()) line = data_line("the counts"), position = 0, token = next_token(line, position);
    const long long vertices = count(token, "vertices"), faces = count(next_token(line, position), "faces");
    for (long long i = 0; i < vertices; ++i) read_vertex(i);
    for (long long i = 0; i < faces; ++i) read_face(i);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}; correct the line or export the file again", path_, line_, what));
  }
  long long count(std::string_view token, const char* what) const {
    long long n = 0;
    if (!parse_number(token, n) || n < 0) fail(fmt::format("'{}' is no number of {}", token, what));
    if (n > 0x7FFFFFFF) fail(fmt::format("{} {} are too many", n, what));
    return n;
  }
  // The next line that is neither empty nor a comment, without a comment at its end.
  std::string_view data_line(const std::string& wanted) {
    while (at_ < content_.size()) {
      const std::size_t end = std::min(content_.find('\n', at_), content_.size());
      std::string_view line(content_.data() + at_, end - at_);
      at_ = end + 1, ++line_;
      line = line.substr(0, line.find('#'));
      std::size_t position = 0;
      if (!next_token(line, position).empty()) return line;
    }
    fail(fmt::format("the file ends where {} should stand", wanted));
  }
  void read_vertex(long long i) {
    const std::string_view line = data_line(fmt::format("vertex {}", i));
    std::size_t position = 0;
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      const std::string_view token = next_token(line, position);
      if (!parse_number(token, p[k]) || !std::isfinite(p[k]))
        fail(fmt::format("vertex {}: '{}' is no finite coordinate", i, token));
    }
    mesh_.vertices.push_back(p);
  }
  void read_face(long long i) {
    const std::string_view line = data_line(fmt::format("face {}", i));
    std::size_t position = 0;
    const long long n = count(next_token(line, position), "vertices of a face");
    if (n < 3) fail(fmt::format("face {} has {} vertices", i, n));
    std::vector<std::uint32_t> polygon;
    for (long long k = 0; k < n; ++k) {
      long long v = -1;
      const std::string_view token = next_token(line, position);
      if (!parse_number(token, v) || v < 0 || v >= static_cast<long long>(mesh_.vertex_count()))
        fail(fmt::format("face {}: '{}' is none of {} vertices (they count from 0)", i, token, mesh_.vertex_count()));
      polygon.push_back(static_cast<std::uint32_t>(v));
    }
    add_polygon(polygon, mesh_);
  }

  const std::string& path_;
  const std::string& content_;
  std::size_t at_ = 0, line_ = 0;
  SurfaceMesh mesh_;
};

}  // namespace

SurfaceMesh read_off(const std::string& path, const std::string& content) {
  return OffReader(path, content).read();
}

}  // namespace sherd
