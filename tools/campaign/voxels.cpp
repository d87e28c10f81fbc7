#include "tools/campaign/voxels.h"

#include <map>

namespace sherd::campaign {

SurfaceMesh make_voxels(const std::array<int, 3>& size, const std::function<bool(int, int, int)>& filled, Real edge) {
  using Lattice = std::array<int, 3>;
  const auto solid = [&](const Lattice& c) {
    for (std::size_t a = 0; a < 3; ++a)
      if (c[a] < 0 || c[a] >= size[a]) return false;
    return filled(c[0], c[1], c[2]);
  };
  SurfaceMesh mesh;
  std::map<Lattice, std::uint32_t> number;
  const auto vertex = [&](const Lattice& p) {
    const auto [at, fresh] = number.try_emplace(p, static_cast<std::uint32_t>(mesh.vertex_count()));
    if (fresh) mesh.vertices.push_back(edge * Vec3{Real(p[0]), Real(p[1]), Real(p[2])});
    return at->second;
  };
  const auto square = [&](const Lattice& cube, std::size_t axis, bool high) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    Lattice p = cube;
    p[axis] += high;
    Lattice pu = p, pv = p, puv = p;
    ++pu[u], ++pv[v], ++puv[u], ++puv[v];
    const std::uint32_t a = vertex(p), b = vertex(pu), c = vertex(puv), d = vertex(pv);
    if (high)
      mesh.add_triangle(a, b, c), mesh.add_triangle(a, c, d);
    else
      mesh.add_triangle(a, c, b), mesh.add_triangle(a, d, c);
  };
  for (int i = 0; i < size[0]; ++i)
    for (int j = 0; j < size[1]; ++j)
      for (int k = 0; k < size[2]; ++k) {
        const Lattice cube{i, j, k};
        if (!solid(cube)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const bool high : {false, true}) {
            Lattice next = cube;
            next[axis] += high ? 1 : -1;
            if (!solid(next)) square(cube, axis, high);
          }
      }
  return mesh;
}

SurfaceMesh make_double_torus(Real edge) {
  return make_voxels(
      {20, 12, 4},
      [](int i, int j, int) {
        const bool hole = j >= 4 && j < 8 && ((i >= 4 && i < 8) || (i >= 12 && i < 16));
        return !hole;
      },
      edge);
}

SurfaceMesh make_cheese(Real edge) {
  return make_voxels(
      {22, 10, 6},
      [](int i, int j, int k) {
        // Two rows of five, alternately one and two cubes wide.
        const int column = (i - 2) / 4, inside = (i - 2) % 4, row = (j - 2) / 4, across = (j - 2) % 4;
        if (i < 2 || j < 2 || column >= 5 || row >= 2) return true;
        const int width = 1 + (column + row) % 2;
        return !(inside < width && across < width && k >= 2 && k < 2 + width);
      },
      edge);
}

}  // namespace sherd::campaign
