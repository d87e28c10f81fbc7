#include "engine/mesh/remesh_part.h"

#include <algorithm>
#include <cmath>

#include "engine/mesh/attributes.h"
#include "engine/mesh/validate_edges.h"

namespace sherd {
namespace {

constexpr Real kMargin = 0.5;       // of the target length: how far changed faces may reach from where they were
constexpr Real kLargestPart = 0.7;  // of the faces: beyond, cutting out saves nothing
constexpr Real kMostCells = 64;     // a face over more cells of the grid is near whatever its box meets

// Cells of a grid that the boxes of some faces cover.
class Cells {
 public:
  Cells(const Vec3& origin, Real size) : origin_(origin), size_(size) {}

  void cover(const Box& box) {
    all_.grow(box);
    visit(box, [&](std::uint64_t key) {
      keys_.push_back(key);
      return false;
    });
  }
  void sort() {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  }
  bool meets(const Box& box) const {
    if (!all_.overlaps(box)) return false;
    const Vec3 extent = (box.high - box.low) / size_;
    if ((extent.x + 1) * (extent.y + 1) * (extent.z + 1) > kMostCells) return true;
    return visit(box, [&](std::uint64_t key) { return std::binary_search(keys_.begin(), keys_.end(), key); });
  }

 private:
  // Until `stop` says so; true when it did. Different cells may share a key: harmless, a few faces too many.
  template <class Stop>
  bool visit(const Box& box, const Stop& stop) const {
    const auto cell = [&](Real x, Real o) { return static_cast<std::int64_t>(std::floor((x - o) / size_)); };
    for (std::int64_t i = cell(box.low.x, origin_.x); i <= cell(box.high.x, origin_.x); ++i)
      for (std::int64_t j = cell(box.low.y, origin_.y); j <= cell(box.high.y, origin_.y); ++j)
        for (std::int64_t k = cell(box.low.z, origin_.z); k <= cell(box.high.z, origin_.z); ++k)
          if (stop((static_cast<std::uint64_t>(i) & 0x1FFFFF) << 42 | (static_cast<std::uint64_t>(j) & 0x1FFFFF) << 21 |
                   (static_cast<std::uint64_t>(k) & 0x1FFFFF)))
            return true;
    return false;
  }

  Vec3 origin_;
  Real size_;
  Box all_;
  std::vector<std::uint64_t> keys_;
};

Box box_of_face(const SurfaceMesh& mesh, std::size_t t, Real margin) {
  Box box;
  for (int k = 0; k < 3; ++k) box.grow(mesh.corner(t, k));
  const Vec3 m{margin, margin, margin};
  return {box.low - m, box.high + m};
}

std::vector<std::uint8_t> choose_faces(const SurfaceMesh& mesh, const RemeshOptions& options) {
  const std::size_t n = mesh.triangle_count();
  std::vector<std::uint8_t> in(n, 0), touched(mesh.vertex_count(), 0);
  const Real size = options.edge_length;
  Cells cells(n > 0 ? mesh.corner(0, 0) : Vec3{}, 2 * size);
  for (std::size_t t = 0; t < n; ++t) {
    const Triangle& f = mesh.triangles[t];
    if (std::all_of(f.begin(), f.end(), [&](std::uint32_t v) { return options.locked[v] != 0; })) continue;
    in[t] = 1;
    for (const std::uint32_t v : f) touched[v] = 1;
    cells.cover(box_of_face(mesh, t, kMargin * size));
  }
  cells.sort();
  for (std::size_t t = 0; t < n; ++t) {
    if (in[t] != 0) continue;
    const Triangle& f = mesh.triangles[t];
    in[t] = std::any_of(f.begin(), f.end(), [&](std::uint32_t v) { return touched[v] != 0; }) ||
            cells.meets(box_of_face(mesh, t, 0));
  }
  return in;
}

// One vertex of the part for each fan of triangles: a border may touch itself at a vertex.
void name_vertices(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces, MeshPart& part) {
  SurfaceMesh& m = part.mesh;
  for (const std::uint32_t f : faces) m.triangles.push_back(mesh.triangles[f]);
  const std::vector<std::uint32_t> twin = build_twins(m);
  DisjointSets corners(3 * m.triangles.size());
  for (std::uint32_t h = 0; h < twin.size(); ++h) {
    if (twin[h] == kNone || h > twin[h]) continue;
    const auto next = [](std::uint32_t e) { return e % 3 == 2 ? e - 2 : e + 1; };
    corners.join(h, next(twin[h])), corners.join(next(h), twin[h]);
  }
  // In the order of the whole's vertices, so that locked ones keep it.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> fans;
  for (std::uint32_t c = 0; c < 3 * m.triangles.size(); ++c)
    if (corners.find(c) == c) fans.emplace_back(m.triangles[c / 3][c % 3], c);
  std::sort(fans.begin(), fans.end());
  std::vector<std::uint32_t> name(3 * m.triangles.size(), kNone);
  for (const auto& [v, c] : fans) {
    name[c] = static_cast<std::uint32_t>(part.vertex_of.size());
    part.vertex_of.push_back(v), m.vertices.push_back(mesh.vertices[v]);
  }
  match_channels(mesh, m);
  for (CornerChannel& c : m.channels) c.value.clear();
  m.triangles.clear();
  for (std::uint32_t i = 0; i < faces.size(); ++i)
    append_face(mesh, faces[i],
                {name[corners.find(3 * i)], name[corners.find(3 * i + 1)], name[corners.find(3 * i + 2)]}, m);
}

// False when the border comes where vertices may change: the whole is open there.
bool close_borders(const std::vector<std::uint8_t>& locked, MeshPart& part) {
  SurfaceMesh& m = part.mesh;
  const std::vector<std::uint32_t> twin = build_twins(m);
  std::vector<std::uint32_t> next(m.vertex_count(), kNone);  // along the border
  for (std::uint32_t h = 0; h < twin.size(); ++h)
    if (twin[h] == kNone) {
      const std::uint32_t a = m.triangles[h / 3][h % 3], b = m.triangles[h / 3][(h + 1) % 3];
      if (locked[part.vertex_of[a]] == 0 || locked[part.vertex_of[b]] == 0) return false;
      next[a] = b;
    }
  for (std::uint32_t start = 0; start < next.size(); ++start) {
    if (next[start] == kNone) continue;
    const auto apex = static_cast<std::uint32_t>(m.vertex_count());
    std::vector<std::uint32_t> loop;
    Vec3 sum;
    for (std::uint32_t v = start; next[v] != kNone;) {
      const std::uint32_t w = next[v];
      loop.push_back(v), sum += m.vertices[v];
      next[v] = kNone, v = w;
    }
    m.vertices.push_back(sum / static_cast<Real>(loop.size())), part.vertex_of.push_back(kNone);
    for (std::size_t i = 0; i < loop.size(); ++i) m.add_triangle(loop[(i + 1) % loop.size()], loop[i], apex);
  }
  return true;
}

}  // namespace

std::optional<MeshPart> cut_out_part(const SurfaceMesh& mesh, const RemeshOptions& options) {
  MeshPart part;
  part.in_part = choose_faces(mesh, options);
  std::vector<std::uint32_t> faces;
  for (std::uint32_t t = 0; t < part.in_part.size(); ++t)
    if (part.in_part[t] != 0) faces.push_back(t);
  if (static_cast<Real>(faces.size()) > kLargestPart * static_cast<Real>(mesh.triangle_count())) return std::nullopt;
  part.faces = faces.size();
  name_vertices(mesh, faces, part);
  if (faces.empty() || !close_borders(options.locked, part)) return std::nullopt;
  part.options = options;
  part.options.locked.clear(), part.options.size.clear();
  for (const std::uint32_t v : part.vertex_of) {
    part.options.locked.push_back(v == kNone ? 1 : options.locked[v]);
    if (!options.size.empty()) part.options.size.push_back(v == kNone ? options.edge_length : options.size[v]);
  }
  return part;
}

SurfaceMesh put_back(const SurfaceMesh& mesh, const MeshPart& part, const RemeshedPart& remeshed,
                     std::size_t& first_new) {
  // Where each vertex of the whole is now; those of the part that are gone stay out.
  std::vector<std::uint32_t> whole_of(remeshed.vertex_of.size(), kNone);
  std::vector<std::uint8_t> gone(mesh.vertex_count(), 0);
  for (const std::uint32_t v : part.vertex_of)
    if (v != kNone) gone[v] = 1;
  for (std::size_t i = 0; i < whole_of.size(); ++i)
    if (remeshed.vertex_of[i] != kNone) whole_of[i] = part.vertex_of[remeshed.vertex_of[i]], gone[whole_of[i]] = 0;
  SurfaceMesh out;
  out.vertices.reserve(mesh.vertex_count() + remeshed.mesh.vertex_count());
  std::vector<std::uint32_t> place(mesh.vertex_count(), kNone);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (gone[v] != 0) continue;
    place[v] = static_cast<std::uint32_t>(out.vertex_count());
    out.vertices.push_back(mesh.vertices[v]);
  }
  std::vector<std::uint32_t> name(whole_of.size());
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool old = whole_of[i] != kNone;
    name[i] = old ? place[whole_of[i]] : static_cast<std::uint32_t>(out.vertex_count());
    if (old)
      out.vertices.set(name[i], remeshed.mesh.vertices[i]);
    else
      out.vertices.push_back(remeshed.mesh.vertices[i]);
  }
  match_channels(mesh, out);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (part.in_part[t] != 0) continue;
    const Triangle& f = mesh.triangles[t];
    append_face(mesh, t, {place[f[0]], place[f[1]], place[f[2]]}, out);
  }
  first_new = out.triangle_count();
  for (std::uint32_t t = 0; t < remeshed.mesh.triangle_count(); ++t) {
    const Triangle& f = remeshed.mesh.triangles[t];
    append_face(remeshed.mesh, t, {name[f[0]], name[f[1]], name[f[2]]}, out);
  }
  return out;
}

}  // namespace sherd
