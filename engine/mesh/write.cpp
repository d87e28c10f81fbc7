#include "engine/mesh/write.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "engine/mesh/attributes.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

template <class T>
void append(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof(T));
  out.append(bytes, sizeof(T));
}

void save(const std::string& content, const std::string& path) {
  const std::string partial = path + ".partial";
  errno = 0;
  std::ofstream file(partial, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  std::error_code ignored;
  if (!file) {
    const std::string why = errno != 0 ? std::strerror(errno) : "write failed";
    std::filesystem::remove(partial, ignored);
    throw InputError(
        fmt::format("{}: cannot write the mesh ({}); check the folder, its permissions and free space", path, why));
  }
  std::error_code error;
  std::filesystem::rename(partial, path, error);
  if (error) {
    std::filesystem::remove(partial, ignored);
    throw InputError(
        fmt::format("{}: cannot put the written mesh in place ({}); choose another name", path, error.message()));
  }
}

bool has_cracks(const SurfaceMesh& mesh) {
  return std::find(mesh.faces.kind.begin(), mesh.faces.kind.end(), FaceKind::kCrack) != mesh.faces.kind.end();
}

void check_columns(const SurfaceMesh& mesh) {
  const std::string text = check_attributes(mesh);
  SHERD_CHECK(text.empty(), "{}", text);
}

}  // namespace

void write_ply(const SurfaceMesh& mesh, const std::string& path, PlyPrecision precision) {
  const bool cracks = has_cracks(mesh), wide = precision == PlyPrecision::kDouble;
  if (cracks) check_columns(mesh);
  const char* real = wide ? "double" : "float";
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty {} x\nproperty {} y\nproperty {} z\n"
      "element face {}\nproperty list uchar int vertex_indices\n{}end_header\n",
      mesh.vertex_count(), real, real, real, mesh.triangle_count(),
      cracks ? "property uchar kind\nproperty int crack\nproperty int source\n" : "");
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
    }
  }
  save(out, path);
}

void write_obj(const SurfaceMesh& mesh, const std::string& path) {
  const bool cracks = has_cracks(mesh);
  if (cracks) check_columns(mesh);
  std::string out;
  auto sink = std::back_inserter(out);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3 p = mesh.vertices[i];
    fmt::format_to(sink, "v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
  }
  const auto faces = [&](FaceKind kind) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      if (!cracks || mesh.faces.kind[t] == kind) {
        const Triangle& f = mesh.triangles[t];
        fmt::format_to(sink, "f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
      }
  };
  if (cracks) out += "g original\n";
  faces(FaceKind::kOriginal);
  if (cracks) {
    out += "g crack\n";
    faces(FaceKind::kCrack);
  }
  save(out, path);
}

}  // namespace sherd
