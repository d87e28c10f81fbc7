// PLY, ascii and binary: element vertex (x, y, z) and element face (vertex_indices or vertex_index). Floating-point
// properties of vertices become corner channels of their name, texture coordinates (s and t, u and v, or texture_u and
// texture_v) the channel "uv"; normals do not. Lists of floats of faces with as many values for each corner become
// channels too, "texcoord" the channel "uv". The rest is skipped.
#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "engine/mesh/load_raw.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
constexpr std::size_t kMostComponents = 16;  // of a corner channel
constexpr std::size_t kTypeSize[] = {1, 1, 2, 2, 4, 4, 4, 8};

std::optional<Type> type_of(std::string_view name) {
  const struct {
    std::string_view a, b;
    Type type;
  } names[] = {{"char", "int8", Type::kInt8},      {"uchar", "uint8", Type::kUint8},
               {"short", "int16", Type::kInt16},   {"ushort", "uint16", Type::kUint16},
               {"int", "int32", Type::kInt32},     {"uint", "uint32", Type::kUint32},
               {"float", "float32", Type::kFloat}, {"double", "float64", Type::kDouble}};
  for (const auto& n : names)
    if (name == n.a || name == n.b) return n.type;
  return std::nullopt;
}

struct Property {
  std::string name;
  Type type{};
  bool list = false;
  Type count_type{};
};
struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
  // Fewest bytes one entry can take, to tell a truncated file from its header.
  std::size_t least_bytes(bool binary) const {
    std::size_t bytes = 0;
    for (const Property& p : properties)
      bytes += binary ? kTypeSize[static_cast<int>(p.list ? p.count_type : p.type)] : 2;
    return bytes;
  }
};

class PlyReader {
 public:
  PlyReader(const std::string& path, const std::string& content) : path_(path), content_(content) {}

  SurfaceMesh read() {
    read_header();
    std::size_t bytes = 0;
    for (const Element& e : elements_) {
      const std::size_t each = e.least_bytes(binary_);
      if (each > 0 && e.count > content_.size() / each) truncated(e, 0);
      bytes += e.count * each;
    }
    if (bytes > content_.size() - at_ + 1) truncated(elements_.back(), 0);  // an ascii file may lack the last line end
    bool vertices = false, faces = false;
    for (const Element& e : elements_) {
      if (e.name == "vertex")
        vertices = true, read_vertices(e);
      else if (e.name == "face")
        faces = true, read_faces(e);
      else
        skip(e);
    }
    if (!vertices) fail("it has no element 'vertex'");
    if (!faces) fail("it has no element 'face' (a point cloud, or triangle strips); export triangles");
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      for (const std::uint32_t v : polygons_[i])
        if (v >= mesh_.vertex_count())
          fail(fmt::format("face {} (counted from 0) uses vertex {} of {}", i, v, mesh_.vertex_count()));
      if (i == 0)
        for (std::size_t c = 0; c < of_corners_.size(); ++c) of_corners_[c].components = components_of(c);
      add_face(i);
    }
    collect_channels();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: not a usable PLY file: {}; export the file again", path_, what));
  }
  [[noreturn]] void truncated(const Element& e, std::size_t i) const {
    fail(fmt::format("it is truncated: the header promises {} entries of '{}', the data ends {}", e.count, e.name,
                     i == 0 ? "before they can fit" : fmt::format("in entry {}", i)));
  }

  std::string_view header_line() {
    const std::size_t end = content_.find('\n', at_);
    if (end == std::string::npos) fail("the header has no end_header");
    std::string_view line(content_.data() + at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = end + 1;
    return line;
  }
  void read_header() {
    if (header_line() != "ply") fail("the first line is not 'ply'");
    for (;;) {
      const std::string_view line = header_line();
      std::size_t position = 0;
      const std::string_view keyword = next_token(line, position);
      if (keyword == "end_header") break;
      if (keyword == "format")
        read_format(next_token(line, position));
      else if (keyword == "element")
        read_element(line, position);
      else if (keyword == "property")
        read_property(line, position);
    }
    if (!format_known_) fail("the header has no format line");
    if (elements_.empty()) fail("the header lists no elements");
  }
  void read_format(std::string_view format) {
    if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
      fail(fmt::format("unknown format '{}'", format));
    format_known_ = true, binary_ = format != "ascii";
    swap_ = binary_ && (format == "binary_big_endian") == (std::endian::native == std::endian::little);
  }
  void read_element(std::string_view line, std::size_t position) {
    Element e;
    e.name = next_token(line, position);
    long long count = 0;
    if (!parse_number(next_token(line, position), count) || count < 0)
      fail(fmt::format("the header line '{}' has no count", line));
    e.count = static_cast<std::size_t>(count);
    elements_.push_back(e);
  }
  void read_property(std::string_view line, std::size_t position) {
    if (elements_.empty()) fail(fmt::format("the header line '{}' comes before any element", line));
    Property p;
    std::string_view type = next_token(line, position);
    p.list = type == "list";
    if (p.list) {
      const auto count_type = type_of(next_token(line, position));
      if (!count_type || *count_type >= Type::kFloat) fail(fmt::format("unknown type in the header line '{}'", line));
      p.count_type = *count_type;
      type = next_token(line, position);
    }
    const auto value_type = type_of(type);
    if (!value_type) fail(fmt::format("unknown type in the header line '{}'", line));
    p.type = *value_type, p.name = next_token(line, position);
    elements_.back().properties.push_back(p);
  }

  template <class T>
  double binary_value() {
    char bytes[sizeof(T)];
    std::memcpy(bytes, content_.data() + at_, sizeof(T));
    if (swap_) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    at_ += sizeof(T);
    return static_cast<double>(value);
  }
  // Every PLY type fits a double exactly.
  double value(Type type, const Element& e, std::size_t i) {
    if (!binary_) {
      double v = 0;
      const std::string_view token = next_token(content_, at_);
      if (token.empty()) truncated(e, i);
      if (!parse_number(token, v)) fail(fmt::format("'{}' in entry {} of '{}' is no number", token, i, e.name));
      return v;
    }
    if (content_.size() - at_ < kTypeSize[static_cast<int>(type)]) truncated(e, i);
    switch (type) {
      case Type::kInt8:
        return binary_value<std::int8_t>();
      case Type::kUint8:
        return binary_value<std::uint8_t>();
      case Type::kInt16:
        return binary_value<std::int16_t>();
      case Type::kUint16:
        return binary_value<std::uint16_t>();
      case Type::kInt32:
        return binary_value<std::int32_t>();
      case Type::kUint32:
        return binary_value<std::uint32_t>();
      case Type::kFloat:
        return binary_value<float>();
      case Type::kDouble:
        break;
    }
    return binary_value<double>();
  }
  std::size_t list_length(const Property& p, const Element& e, std::size_t i) {
    const double n = value(p.count_type, e, i);
    if (!(n >= 0 && n <= static_cast<double>(content_.size())))
      fail(fmt::format("entry {} of '{}' has a list of {} values", i, e.name, n));
    return static_cast<std::size_t>(n);
  }
  void skip(const Property& p, const Element& e, std::size_t i) {
    const std::size_t n = p.list ? list_length(p, e, i) : 1;
    for (std::size_t k = 0; k < n; ++k) value(p.type, e, i);
  }
  void skip(const Element& e) {
    for (std::size_t i = 0; i < e.count; ++i)
      for (const Property& p : e.properties) skip(p, e, i);
  }
  float attribute(const Property& p, const Element& e, std::size_t i) {
    const auto x = static_cast<float>(value(p.type, e, i));
    if (!std::isfinite(x)) fail(fmt::format("'{}' of entry {} of '{}' is not a finite number", p.name, i, e.name));
    return x;
  }

  // Components of a list of floats with as many for each corner of every face; 0 when it is something else.
  int components_of(std::size_t list) const {
    int components = 0;
    if (corner_values_[list].size() != polygons_.size()) return 0;
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      const std::size_t n = corner_values_[list][i].size(), each = n / polygons_[i].size();
      if (n == 0 || n % polygons_[i].size() != 0 || each > kMostComponents) return 0;
      if (components == 0) components = static_cast<int>(each);
      if (static_cast<int>(each) != components) return 0;
    }
    return components;
  }

  // The polygon's triangles, with what lists of the face say at their corners.
  void add_face(std::size_t i) {
    for (const Triangle& t : triangulate_polygon(polygons_[i], mesh_)) {
      mesh_.add_triangle(polygons_[i][t[0]], polygons_[i][t[1]], polygons_[i][t[2]]);
      for (const std::uint32_t corner : t)
        for (std::size_t c = 0; c < of_corners_.size(); ++c) {
          const auto n = static_cast<std::size_t>(of_corners_[c].components);
          if (n == 0) continue;
          const auto first = corner_values_[c][i].begin() + static_cast<std::ptrdiff_t>(n * corner);
          of_corners_[c].value.insert(of_corners_[c].value.end(), first, first + static_cast<std::ptrdiff_t>(n));
        }
    }
  }

  void collect_channels() {
    for (CornerChannel& c : of_corners_)
      if (c.components > 0) mesh_.channels.push_back(std::move(c));
    // A file with two elements 'vertex' has values for some vertices only.
    std::erase_if(of_vertices_, [&](const CornerChannel& c) { return c.value.size() != mesh_.vertex_count(); });
    const auto known = [&](const std::string& name) {
      return std::any_of(mesh_.channels.begin(), mesh_.channels.end(),
                         [&](const CornerChannel& c) { return c.name == name; });
    };
    const auto find = [&](const char* name) {
      return std::find_if(of_vertices_.begin(), of_vertices_.end(),
                          [&](const CornerChannel& c) { return c.name == name; });
    };
    for (const auto& [first, second] :
         {std::pair{"s", "t"}, std::pair{"u", "v"}, std::pair{"texture_u", "texture_v"}}) {
      const auto u = find(first), v = find(second);
      if (u == of_vertices_.end() || v == of_vertices_.end()) continue;
      CornerChannel both{"uv", 2, {}};
      for (std::size_t i = 0; i < u->value.size(); ++i)
        both.value.push_back(u->value[i]), both.value.push_back(v->value[i]);
      of_vertices_.erase(std::max(u, v)), of_vertices_.erase(std::min(u, v));
      if (!known("uv")) add_channel(both);
    }
    for (const CornerChannel& c : of_vertices_)
      if (!known(c.name)) add_channel(c);
  }
  // From values at vertices.
  void add_channel(const CornerChannel& of_vertices) {
    const auto n = static_cast<std::ptrdiff_t>(of_vertices.components);
    CornerChannel channel{of_vertices.name, of_vertices.components, {}};
    for (const Triangle& t : mesh_.triangles)
      for (const std::uint32_t v : t) {
        const auto first = of_vertices.value.begin() + n * static_cast<std::ptrdiff_t>(v);
        channel.value.insert(channel.value.end(), first, first + n);
      }
    mesh_.channels.push_back(std::move(channel));
  }

  void read_vertices(const Element& e) {
    for (const char* axis : {"x", "y", "z"})
      if (std::none_of(e.properties.begin(), e.properties.end(),
                       [&](const Property& p) { return p.name == axis && !p.list; }))
        fail(fmt::format("its vertices have no property '{}'", axis));
    mesh_.vertices.reserve(e.count);
    std::vector<int> slot;
    for (const Property& p : e.properties) {
      const bool wanted = !p.list && p.type >= Type::kFloat && p.name != "nx" && p.name != "ny" && p.name != "nz" &&
                          p.name != "x" && p.name != "y" && p.name != "z";
      slot.push_back(wanted ? static_cast<int>(of_vertices_.size()) : -1);
      if (wanted) of_vertices_.push_back({p.name, 1, {}});
    }
    for (std::size_t i = 0; i < e.count; ++i) {
      Vec3 point;
      for (std::size_t k = 0; k < slot.size(); ++k) {
        const Property& p = e.properties[k];
        if (slot[k] >= 0) {
          of_vertices_[static_cast<std::size_t>(slot[k])].value.push_back(attribute(p, e, i));
          continue;
        }
        const int axis = p.list || p.name.size() != 1 ? -1 : p.name[0] - 'x';
        if (axis < 0 || axis > 2) {
          skip(p, e, i);
          continue;
        }
        point[axis] = value(p.type, e, i);
        if (!std::isfinite(point[axis]))
          fail(fmt::format("vertex {} (counted from 0) has a coordinate that is not finite", i));
      }
      mesh_.vertices.push_back(point);
    }
  }
  void read_faces(const Element& e) {
    const auto is_corner_list = [](const Property& p) {
      return p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::none_of(e.properties.begin(), e.properties.end(), is_corner_list))
      fail("its faces have no list 'vertex_indices'");
    polygons_.reserve(e.count);
    std::vector<int> slot;
    for (const Property& p : e.properties) {
      const bool wanted = p.list && p.type >= Type::kFloat;
      slot.push_back(wanted ? static_cast<int>(of_corners_.size()) : -1);
      if (wanted) of_corners_.push_back({p.name == "texcoord" ? "uv" : p.name, 0, {}});
    }
    corner_values_.resize(of_corners_.size());
    for (std::size_t i = 0; i < e.count; ++i)
      for (std::size_t s = 0; s < slot.size(); ++s) {
        const Property& p = e.properties[s];
        if (slot[s] >= 0) {
          std::vector<float> values(list_length(p, e, i));
          for (float& x : values) x = attribute(p, e, i);
          corner_values_[static_cast<std::size_t>(slot[s])].push_back(std::move(values));
          continue;
        }
        if (!is_corner_list(p)) {
          skip(p, e, i);
          continue;
        }
        const std::size_t n = list_length(p, e, i);
        if (n < 3) fail(fmt::format("face {} (counted from 0) has {} vertices", i, n));
        std::vector<std::uint32_t> polygon;
        for (std::size_t k = 0; k < n; ++k) {
          const double v = value(p.type, e, i);
          if (!(v >= 0 && v < 4294967295.0 && v == std::floor(v)))
            fail(fmt::format("face {} (counted from 0) uses vertex {} of {}", i, v, mesh_.vertex_count()));
          polygon.push_back(static_cast<std::uint32_t>(v));
        }
        polygons_.push_back(std::move(polygon));
      }
  }

  const std::string& path_;
  const std::string& content_;
  std::size_t at_ = 0;
  bool format_known_ = false, binary_ = false, swap_ = false;
  std::vector<Element> elements_;
  SurfaceMesh mesh_;
  std::vector<std::vector<std::uint32_t>> polygons_;
  std::vector<CornerChannel> of_vertices_, of_corners_;         // floating-point properties and lists
  std::vector<std::vector<std::vector<float>>> corner_values_;  // per list and face
};

}  // namespace

SurfaceMesh read_ply(const std::string& path, const std::string& content) {
  return PlyReader(path, content).read();
}

}  // namespace sherd
