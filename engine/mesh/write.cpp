#include "engine/mesh/write.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "engine/mesh/attributes.h"
#include "kernels/core/error.h"
#include "kernels/core/file.h"

namespace sherd {
namespace {

template <class T>
void append(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof(T));
  out.append(bytes, sizeof(T));
}

bool has_cracks(const SurfaceMesh& mesh) {
  return std::find(mesh.faces.kind.begin(), mesh.faces.kind.end(), FaceKind::kCrack) != mesh.faces.kind.end();
}

// As lists with the values of the three corners one after the other; "uv" under the name that other programs read.
std::string channel_header(const SurfaceMesh& mesh) {
  std::string text;
  for (const CornerChannel& c : mesh.channels)
    text += fmt::format("property list uchar float {}\n", c.name == "uv" ? "texcoord" : c.name);
  return text;
}

void check_columns(const SurfaceMesh& mesh) {
  const std::string text = check_attributes(mesh);
  SHERD_CHECK(text.empty(), "{}", text);
}

}  // namespace

void write_ply(const SurfaceMesh& mesh, const std::string& path, PlyPrecision precision) {
  const bool cracks = has_cracks(mesh), wide = precision == PlyPrecision::kDouble;
  if (cracks || !mesh.channels.empty()) check_columns(mesh);
  const char* real = wide ? "double" : "float";
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty {} x\nproperty {} y\nproperty {} z\n"
      "element face {}\nproperty list uchar int vertex_indices\n{}end_header\n",
      mesh.vertex_count(), real, real, real, mesh.triangle_count(),
      (cracks ? "property uchar kind\nproperty int crack\nproperty int source\nproperty char side\n"
                "property ushort material\n"
              : "") +
          channel_header(mesh));
  out.reserve(out.size() + mesh.vertex_count() * 3 * sizeof(double) + mesh.triangle_count() * 22);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
    for (int k = 0; k < 3; ++k) {
      const Real value = mesh.vertices[i][k];
      if (wide)
        append(out, value);
      else
        append(out, static_cast<float>(value));
    }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    append(out, std::uint8_t{3});
    for (const std::uint32_t v : mesh.triangles[t]) append(out, v);
    if (cracks) {
      append(out, static_cast<std::uint8_t>(mesh.faces.kind[t]));
      append(out, mesh.faces.crack[t]);
      append(out, mesh.faces.source[t]);
      append(out, mesh.faces.side[t]);
      append(out, mesh.faces.material[t]);
    }
    for (const CornerChannel& c : mesh.channels) {
      append(out, static_cast<std::uint8_t>(c.width()));
      for (std::size_t i = 0; i < c.width(); ++i) append(out, c.value[c.width() * t + i]);
    }
  }
  replace_file(path, out);
}

void write_obj(const SurfaceMesh& mesh, const std::string& path) {
  const bool cracks = has_cracks(mesh);
  if (cracks || !mesh.channels.empty()) check_columns(mesh);
  std::string out;
  auto sink = std::back_inserter(out);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3 p = mesh.vertices[i];
    fmt::format_to(sink, "v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
  }
  const CornerChannel* uv = nullptr;
  for (const CornerChannel& c : mesh.channels)
    if (c.name == "uv" && c.components == 2) uv = &c;
  for (std::size_t i = 0; uv != nullptr && i + 1 < uv->value.size(); i += 2)
    fmt::format_to(sink, "vt {} {}\n", uv->value[i], uv->value[i + 1]);
  const auto faces = [&](FaceKind kind) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      if (!cracks || mesh.faces.kind[t] == kind) {
        const Triangle& f = mesh.triangles[t];
        if (uv == nullptr)
          fmt::format_to(sink, "f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
        else
          fmt::format_to(sink, "f {}/{} {}/{} {}/{}\n", f[0] + 1, 3 * t + 1, f[1] + 1, 3 * t + 2, f[2] + 1, 3 * t + 3);
      }
  };
  if (cracks) out += "g original\n";
  faces(FaceKind::kOriginal);
  if (cracks) {
    out += "g crack\n";
    faces(FaceKind::kCrack);
  }
  replace_file(path, out);
}

}  // namespace sherd
