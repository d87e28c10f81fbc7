#include "tools/exact/meshes.h"

#include <numbers>

#include "engine/mesh/shapes.h"
#include "kernels/core/random.h"

namespace sherd::exact {

SurfaceMesh jittered_box(const Vec3& size, int n, Real jitter) {
  SurfaceMesh mesh = make_box(size, 1.0 / n);
  Random random(1);
  const Real step = jitter / n;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    Vec3 p = mesh.vertices[i];
    for (int a = 0; a < 3; ++a) {
      const Real move = random.uniform(-step, step);
      if (std::abs(p[a]) < 0.5 * size[a] * (1 - 1e-9)) p[a] += move;
    }
    mesh.vertices.set(i, p);
  }
  return mesh;
}

SurfaceMesh jittered_sphere(Real radius, int frequency, Real jitter, std::uint64_t seed) {
  const Real edge = std::sqrt(4 * std::numbers::pi / (5 * std::numbers::sqrt3)) * radius / frequency;
  SurfaceMesh mesh = make_sphere(radius, edge);
  Random random(seed);
  const Real step = jitter * edge;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3 move{random.uniform(-step, step), random.uniform(-step, step), random.uniform(-step, step)};
    mesh.vertices.set(i, normalized(mesh.vertices[i] + move) * radius);
  }
  return mesh;
}

SurfaceMesh jittered_hollow_sphere(Real outer, Real inner, int frequency, Real jitter) {
  SurfaceMesh mesh = jittered_sphere(outer, frequency, jitter, 1);
  const SurfaceMesh cavity = jittered_sphere(inner, frequency, jitter, 2);
  const auto offset = static_cast<std::uint32_t>(mesh.vertex_count());
  for (std::size_t i = 0; i < cavity.vertex_count(); ++i) mesh.vertices.push_back(cavity.vertices[i]);
  for (const Triangle& t : cavity.triangles) mesh.add_triangle(offset + t[0], offset + t[2], offset + t[1]);
  return mesh;
}

namespace {

// A disc of m rings, ring k of 6 k vertices (ring 0 one); returns the first vertex of the outer ring.
std::uint32_t add_cap(Real radius, Real z, int m, SurfaceMesh& mesh) {
  std::vector<std::uint32_t> first;
  for (int k = 0; k <= m; ++k) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertex_count()));
    const int count = std::max(1, 6 * k);
    for (int i = 0; i < count; ++i) {
      const Real a = 2 * std::numbers::pi * i / count, r = radius * k / m;
      mesh.vertices.push_back({r * std::cos(a), r * std::sin(a), z});
    }
  }
  const auto at = [&](int k, int i) {
    const int count = std::max(1, 6 * k);
    return first[static_cast<std::size_t>(k)] + static_cast<std::uint32_t>(((i % count) + count) % count);
  };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    z > 0 ? mesh.add_triangle(a, b, c) : mesh.add_triangle(a, c, b);
  };
  for (int k = 1; k <= m; ++k)
    for (int sector = 0; sector < 6; ++sector)
      for (int i = 0; i < k; ++i) {
        const int out = sector * k + i, in = sector * (k - 1) + i;
        add(at(k - 1, in), at(k, out), at(k, out + 1));
        if (i + 1 < k) add(at(k - 1, in), at(k, out + 1), at(k - 1, in + 1));
      }
  return first.back();
}

}  // namespace

SurfaceMesh structured_cylinder(Real radius, Real length, int m, int layers) {
  SurfaceMesh mesh;
  const int around = 6 * m;
  std::vector<std::uint32_t> ring;  // first vertex of each ring of the side, bottom to top
  ring.push_back(add_cap(radius, -0.5 * length, m, mesh));
  for (int l = 1; l < layers; ++l) {
    ring.push_back(static_cast<std::uint32_t>(mesh.vertex_count()));
    for (int i = 0; i < around; ++i) {
      const Real a = 2 * std::numbers::pi * i / around;
      mesh.vertices.push_back({radius * std::cos(a), radius * std::sin(a), length * (Real(l) / layers - 0.5)});
    }
  }
  ring.push_back(add_cap(radius, 0.5 * length, m, mesh));
  for (std::size_t l = 0; l + 1 < ring.size(); ++l)
    for (int i = 0; i < around; ++i) {
      const auto k = static_cast<std::uint32_t>(i), next = static_cast<std::uint32_t>((i + 1) % around);
      const std::uint32_t a = ring[l] + k, b = ring[l] + next, c = ring[l + 1] + next, d = ring[l + 1] + k;
      if ((i + static_cast<int>(l)) % 2 == 0)
        mesh.add_triangle(a, b, c), mesh.add_triangle(a, c, d);
      else
        mesh.add_triangle(a, b, d), mesh.add_triangle(b, c, d);
    }
  return mesh;
}

Real mean_edge(const SurfaceMesh& mesh) {
  return std::sqrt(4 * surface_area(mesh) / (std::numbers::sqrt3 * static_cast<Real>(mesh.triangle_count())));
}

}  // namespace sherd::exact
