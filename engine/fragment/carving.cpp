#include "engine/fragment/carving.h"

#include <algorithm>

namespace sherd {

Carving::Carving(const CutBody& body, const CutOperand& slab, const Piercing& piercing)
    : body_(body),
      slab_(slab),
      body_faces_(static_cast<std::uint32_t>(body.mesh().triangle_count())),
      body_vertices_(static_cast<std::uint32_t>(body.mesh().vertex_count())),
      first_crossing_(body_vertices_ + static_cast<std::uint32_t>(slab.mesh.vertex_count())) {
  points_.reserve(slab.mesh.vertex_count() + piercing.points.size());
  for (std::size_t i = 0; i < slab.mesh.vertex_count(); ++i) points_.push_back(slab.mesh.vertices[i]);
  for (const ArrangementPoint& p : piercing.points) points_.push_back(p.position);
  for (const Crossing& c : piercing.crossings) operand_of_.push_back(c.edge_operand);
}

std::array<Vec3, 3> Carving::corners(std::uint32_t f) const {
  if (f < body_faces_) return body_.operand().corners(f);
  const Triangle& t = faces[f - body_faces_].vertices;
  return {position(t[0]), position(t[1]), position(t[2])};
}

std::uint32_t Carving::twin(std::uint32_t e) const {
  if (e >= 3 * body_faces_) return twin_[e - 3 * body_faces_];
  const std::uint32_t t = body_.twins()[e];
  return gone.contains(t / 3) ? border_[e] : t;
}

void Carving::join(std::uint32_t e, std::uint32_t f) {
  for (const auto& [from, to] : {std::pair(e, f), std::pair(f, e)}) {
    if (from >= 3 * body_faces_) {
      twin_[from - 3 * body_faces_] = to;
    } else {
      border_.set(from, to);
    }
  }
}

std::uint32_t Carving::body_edge(const NewFace& face, std::uint32_t k) const {
  if (face.of_slab) return kNone;
  const Triangle& t = body_.mesh().triangles[face.parent];
  for (std::uint32_t j = 0; j < 3; ++j)
    if (t[j] == face.vertices[k] && t[(j + 1) % 3] == face.vertices[(k + 1) % 3]) return 3 * face.parent + j;
  return kNone;
}

std::string Carving::link() {
  struct Edge {
    std::uint32_t low, high, id;
    bool forward;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * faces.size());
  for (std::uint32_t i = 0; i < faces.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = faces[i].vertices[k], b = faces[i].vertices[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), 3 * i + k, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& p, const Edge& q) {
    return p.low != q.low ? p.low < q.low : (p.high != q.high ? p.high < q.high : p.id < q.id);
  });
  twin_.assign(3 * faces.size(), kNone);
  const std::uint32_t shift = 3 * body_faces_;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high) ++j;
    if (j - i == 2 && edges[i].forward != edges[i + 1].forward) {
      join(shift + edges[i].id, shift + edges[i + 1].id);
    } else {
      const std::uint32_t id = edges[i].id, own = body_edge(faces[id / 3], id % 3);
      const std::uint32_t across = own == kNone ? kNone : body_.twins()[own];
      if (j - i != 1 || across == kNone || gone.contains(across / 3)) return "an edge has not exactly one neighbour";
      join(shift + id, across);
    }
    i = j;
  }
  return {};
}

}  // namespace sherd
