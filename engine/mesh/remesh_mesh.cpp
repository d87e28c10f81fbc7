#include "engine/mesh/remesh_mesh.h"

namespace sherd {

bool EditMesh::assign(const SurfaceMesh& mesh, const char*& reason) {
  const std::size_t n = mesh.vertex_count();
  position.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    position[i] = mesh.vertices[i];
    if (!is_finite(position[i])) return reason = "a vertex is not finite", false;
  }
  for (const Triangle& t : mesh.triangles)
    if (t[0] >= n || t[1] >= n || t[2] >= n || t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      return reason = "a triangle has an invalid or repeated vertex", false;
  triangle = mesh.triangles;
  faces = mesh.faces;
  faces.resize(triangle.size());
  region.assign(triangle.size(), 0);
  twin = build_twins(mesh);
  line.assign(twin.size(), kNone);
  out.assign(n, kNone);
  std::vector<std::uint32_t> uses(n, 0);
  for (std::uint32_t h = 0; h < twin.size(); ++h) {
    if (twin[h] == kNone) return reason = "the mesh is open, non-manifold or inconsistently oriented", false;
    out[from(h)] = h;
    ++uses[from(h)];
  }
  for (std::uint32_t v = 0; v < n; ++v)
    if (out[v] != kNone && valence(v) != uses[v]) return reason = "a vertex joins several surfaces", false;
  return true;
}

SurfaceMesh EditMesh::extract(std::vector<std::uint32_t>* faces_of, std::vector<std::uint32_t>* vertices_of) const {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> index(position.size(), kNone);
  for (std::uint32_t t = 0; t < triangle.size(); ++t)
    if (alive(t) && !ghost(t))
      for (const std::uint32_t v : triangle[t]) index[v] = 0;
  for (std::uint32_t v = 0; v < position.size(); ++v) {
    if (index[v] == kNone) continue;
    index[v] = static_cast<std::uint32_t>(mesh.vertex_count());
    mesh.vertices.push_back(position[v]);
    if (vertices_of != nullptr) vertices_of->push_back(v);
  }
  for (std::uint32_t t = 0; t < triangle.size(); ++t) {
    if (!alive(t) || ghost(t)) continue;
    mesh.triangles.push_back({index[triangle[t][0]], index[triangle[t][1]], index[triangle[t][2]]});
    mesh.faces.push_back_from(faces, t);
    if (faces_of != nullptr) faces_of->push_back(t);
  }
  return mesh;
}

std::size_t EditMesh::valence(std::uint32_t v) const {
  std::size_t n = 0;
  for_out(v, [&](std::uint32_t) { ++n; });
  return n;
}

bool EditMesh::adjacent(std::uint32_t a, std::uint32_t b) const {
  bool found = false;
  for_out(a, [&](std::uint32_t h) { found = found || to(h) == b; });
  return found;
}

std::uint32_t EditMesh::split(std::uint32_t h, const Vec3& p) {
  const std::uint32_t t = twin[h], hn = next(h), tn = next(t), a = from(h), b = to(h), c = tip(h), d = tip(t);
  const auto m = static_cast<std::uint32_t>(position.size());
  const auto f = static_cast<std::uint32_t>(3 * triangle.size()), g = f + 3;  // first half-edges of the new triangles
  position.push_back(p);
  triangle[h / 3][hn % 3] = m;
  triangle[t / 3][tn % 3] = m;
  triangle.push_back({m, b, c});
  triangle.push_back({m, a, d});
  const FaceAttributes old = [&] {
    FaceAttributes two;
    two.push_back_from(faces, h / 3), two.push_back_from(faces, t / 3);
    return two;
  }();
  faces.push_back_from(old, 0), faces.push_back_from(old, 1);
  const std::uint32_t here = region[h / 3], there = region[t / 3];
  region.push_back(here), region.push_back(there);
  const std::uint32_t on = line[h], bc = twin[hn], ad = twin[tn], bc_line = line[hn], ad_line = line[tn];
  twin.resize(twin.size() + 6);
  line.resize(line.size() + 6, kNone);
  const auto join = [&](std::uint32_t x, std::uint32_t y, std::uint32_t l) {
    twin[x] = y, twin[y] = x, line[x] = line[y] = l;
  };
  join(f + 1, bc, bc_line), join(g + 1, ad, ad_line);
  join(hn, f + 2, kNone), join(tn, g + 2, kNone);
  join(h, g, on), join(t, f, on);
  out.push_back(f);
  out[a] = h, out[b] = t;
  return m;
}

bool EditMesh::can_collapse(std::uint32_t h) const {
  const std::uint32_t t = twin[h], a = from(h), b = to(h), c = tip(h), d = tip(t);
  if (c == d || valence(c) < 4 || valence(d) < 4) return false;
  bool good = true;
  for_out(a, [&](std::uint32_t x) {
    const std::uint32_t v = to(x);
    if (v != b && v != c && v != d && good) good = !adjacent(v, b);
  });
  return good;
}

void EditMesh::collapse(std::uint32_t h) {
  const std::uint32_t t = twin[h], a = from(h), b = to(h), c = tip(h), d = tip(t);
  const std::uint32_t bc = twin[next(h)], ca = twin[prev(h)], ad = twin[next(t)], db = twin[prev(t)];
  std::uint32_t x = h;
  std::vector<std::uint32_t> around;
  do {
    around.push_back(x);
    x = turn(x);
  } while (x != h);
  for (const std::uint32_t y : around) triangle[y / 3][y % 3] = b;
  // Two lines pinched into one edge keep the first line's id.
  const auto join = [&](std::uint32_t p, std::uint32_t q) {
    const std::uint32_t l = line[p] != kNone ? line[p] : line[q];
    twin[p] = q, twin[q] = p, line[p] = line[q] = l;
  };
  join(bc, ca), join(ad, db);
  out[b] = ca, out[c] = bc, out[d] = ad, out[a] = kNone;
  triangle[h / 3] = triangle[t / 3] = {kNone, kNone, kNone};
}

bool EditMesh::can_flip(std::uint32_t h) const {
  const std::uint32_t t = twin[h];
  return line[h] == kNone && valence(from(h)) > 3 && valence(to(h)) > 3 && tip(h) != tip(t) &&
         !adjacent(tip(h), tip(t));
}

void EditMesh::flip(std::uint32_t h) {
  const std::uint32_t t = twin[h], hn = next(h), tn = next(t), a = from(h), b = to(h), c = tip(h), d = tip(t);
  const std::uint32_t bc = twin[hn], ad = twin[tn], bc_line = line[hn], ad_line = line[tn];
  triangle[h / 3][hn % 3] = d;
  triangle[t / 3][tn % 3] = c;
  const auto join = [&](std::uint32_t x, std::uint32_t y, std::uint32_t l) {
    twin[x] = y, twin[y] = x, line[x] = line[y] = l;
  };
  join(h, ad, ad_line), join(t, bc, bc_line), join(hn, tn, kNone);
  out[a] = h, out[b] = t;
}

}  // namespace sherd
