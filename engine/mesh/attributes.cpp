#include "engine/mesh/attributes.h"

#include <fmt/format.h>

#include <algorithm>

#include "kernels/core/error.h"

namespace sherd {
namespace {

void check_match(const SurfaceMesh& from, const SurfaceMesh& to) {
  SHERD_CHECK(from.channels.size() == to.channels.size(), "{} channels appended to {}", from.channels.size(),
              to.channels.size());
}

}  // namespace

void match_channels(const SurfaceMesh& pattern, SurfaceMesh& mesh) {
  std::vector<CornerChannel> channels;
  for (const CornerChannel& wanted : pattern.channels) {
    CornerChannel channel{wanted.name, wanted.components, {}};
    for (CornerChannel& own : mesh.channels)
      if (own.name == wanted.name && own.components == wanted.components) channel.value = std::move(own.value);
    channel.value.resize(channel.width() * mesh.triangle_count(), 0);
    channels.push_back(std::move(channel));
  }
  mesh.channels = std::move(channels);
}

void copy_corners(const SurfaceMesh& from, std::uint32_t face, SurfaceMesh& to) {
  check_match(from, to);
  for (std::size_t c = 0; c < from.channels.size(); ++c) {
    const std::size_t width = from.channels[c].width();
    const auto first = from.channels[c].value.begin() + static_cast<std::ptrdiff_t>(width * face);
    to.channels[c].value.insert(to.channels[c].value.end(), first, first + static_cast<std::ptrdiff_t>(width));
  }
}

std::array<Real, 3> corner_weights(const SurfaceMesh& mesh, std::uint32_t face, const Vec3& p) {
  const Vec3 a = mesh.corner(face, 0), b = mesh.corner(face, 1), c = mesh.corner(face, 2);
  const Vec3 n = cross(b - a, c - a);
  const Real area2 = norm2(n);
  if (!(area2 > 0)) {
    const Real d[3] = {distance2(p, a), distance2(p, b), distance2(p, c)};
    std::array<Real, 3> w{};
    w[static_cast<std::size_t>(std::min_element(d, d + 3) - d)] = 1;
    return w;
  }
  const Real wb = dot(cross(p - a, c - a), n) / area2, wc = dot(cross(b - a, p - a), n) / area2;
  return {1 - wb - wc, wb, wc};
}

void append_corner(const SurfaceMesh& from, std::uint32_t face, const Vec3& p, SurfaceMesh& to) {
  check_match(from, to);
  if (from.channels.empty()) return;
  const std::array<Real, 3> w = corner_weights(from, face, p);
  for (std::size_t c = 0; c < from.channels.size(); ++c) {
    const auto n = static_cast<std::size_t>(from.channels[c].components);
    const float* v = from.channels[c].value.data() + 3 * n * face;
    for (std::size_t i = 0; i < n; ++i)
      to.channels[c].value.push_back(static_cast<float>(w[0] * static_cast<Real>(v[i]) +
                                                        w[1] * static_cast<Real>(v[n + i]) +
                                                        w[2] * static_cast<Real>(v[2 * n + i])));
  }
}

void interpolate_corners(const SurfaceMesh& from, std::uint32_t face, const std::array<Vec3, 3>& at, SurfaceMesh& to) {
  for (const Vec3& p : at) append_corner(from, face, p, to);
}

void append_face(const SurfaceMesh& from, std::uint32_t face, const Triangle& t, SurfaceMesh& to) {
  to.triangles.push_back(t);
  to.faces.push_back_from(from.faces, face);
  copy_corners(from, face, to);
}

void append_faces(const SurfaceMesh& from, std::uint32_t first, std::uint32_t last, SurfaceMesh& to) {
  check_match(from, to);
  const auto append = [](const auto& source, auto& target, std::size_t begin, std::size_t end) {
    target.insert(target.end(), source.begin() + static_cast<std::ptrdiff_t>(begin),
                  source.begin() + static_cast<std::ptrdiff_t>(end));
  };
  append(from.triangles, to.triangles, first, last);
  append(from.faces.kind, to.faces.kind, first, last);
  append(from.faces.crack, to.faces.crack, first, last);
  append(from.faces.source, to.faces.source, first, last);
  append(from.faces.side, to.faces.side, first, last);
  append(from.faces.material, to.faces.material, first, last);
  for (std::size_t c = 0; c < from.channels.size(); ++c) {
    const std::size_t width = from.channels[c].width();
    append(from.channels[c].value, to.channels[c].value, width * first, width * last);
  }
}

void keep_faces(SurfaceMesh& mesh, const std::vector<bool>& keep) {
  SurfaceMesh kept;
  match_channels(mesh, kept);
  for (std::uint32_t t = 0; t < keep.size(); ++t)
    if (keep[t]) append_face(mesh, t, mesh.triangles[t], kept);
  mesh.triangles = std::move(kept.triangles), mesh.faces = std::move(kept.faces);
  mesh.channels = std::move(kept.channels);
}

void overwrite_face(const SurfaceMesh& from, std::uint32_t face, std::uint32_t slot, SurfaceMesh& to) {
  check_match(from, to);
  to.faces.kind[slot] = from.faces.kind[face], to.faces.crack[slot] = from.faces.crack[face];
  to.faces.source[slot] = from.faces.source[face], to.faces.side[slot] = from.faces.side[face];
  to.faces.material[slot] = from.faces.material[face];
  for (std::size_t c = 0; c < from.channels.size(); ++c) {
    const std::size_t width = from.channels[c].width();
    std::copy_n(from.channels[c].value.data() + width * face, width, to.channels[c].value.data() + width * slot);
  }
}

void turn_face(SurfaceMesh& mesh, std::size_t face) {
  std::swap(mesh.triangles[face][1], mesh.triangles[face][2]);
  for (CornerChannel& c : mesh.channels) {
    const auto n = static_cast<std::ptrdiff_t>(c.components);
    const auto second = c.value.begin() + static_cast<std::ptrdiff_t>(c.width() * face) + n;
    std::swap_ranges(second, second + n, second + n);
  }
}

std::string check_attributes(const SurfaceMesh& mesh) {
  const std::size_t n = mesh.triangle_count();
  const FaceAttributes& f = mesh.faces;
  if (f.kind.size() != n || f.crack.size() != n || f.source.size() != n || f.side.size() != n || f.material.size() != n)
    return fmt::format("face columns of {}, {}, {}, {} and {} entries for {} triangles", f.kind.size(), f.crack.size(),
                       f.source.size(), f.side.size(), f.material.size(), n);
  for (const CornerChannel& c : mesh.channels)
    if (c.components < 1 || c.value.size() != c.width() * n)
      return fmt::format("channel '{}' has {} values of {} components for {} triangles", c.name, c.value.size(),
                         c.components, n);
  return {};
}

}  // namespace sherd
