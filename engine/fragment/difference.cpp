#include "engine/fragment/difference.h"

#include <algorithm>
#include <numeric>

#include "engine/fragment/face_triangulation.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

enum class Fate : char { kUnknown, kKeep, kDrop, kCut };

struct CutFace {
  std::uint32_t face;
  std::vector<std::uint32_t> vertices;  // of the arrangement's points, in the welded numbering
  FaceTriangulation triangulation;      // right of the cut is kept: outside the slab, inside the body
};

// Welded numbering: vertices of the body, of the slab, crossings.
struct Numbering {
  std::uint32_t slab, crossing;
};

// One operand cut along the segments: which whole faces stay, and the parts of the others.
class CutSurface {
 public:
  CutSurface(const CutOperand& operand, const CutOperand& other, std::size_t which, const Piercing& piercing,
             const Numbering& numbering)
      : operand_(operand), other_(other), which_(which), piercing_(piercing), numbering_(numbering) {}

  bool run(std::string& reason) {
    gather();
    parallel_for(parts.size(), 16, [&](std::size_t i) { triangulate(parts[i]); });
    for (const CutFace& c : parts)
      if (!c.triangulation.ok) {
        reason = c.triangulation.reason;
        return false;
      }
    if (!flood()) {
      reason = "the sides of the cut contradict each other";
      return false;
    }
    return label_whole_shells(reason);
  }

  std::uint32_t weld(std::uint32_t vertex) const { return which_ == 0 ? vertex : numbering_.slab + vertex; }

  std::vector<Fate> fate;      // per face
  std::vector<CutFace> parts;  // ascending by face

 private:
  // Cut faces with their segments, in order.
  void gather() {
    fate.assign(operand_.mesh.triangle_count(), Fate::kUnknown);
    order_.resize(piercing_.segments.size());
    std::iota(order_.begin(), order_.end(), 0u);
    const auto face_of = [&](std::uint32_t s) { return piercing_.segments[s].face[which_]; };
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return face_of(a) < face_of(b); });
    for (std::uint32_t i = 0; i < order_.size(); ++i)
      if (i == 0 || face_of(order_[i]) != face_of(order_[i - 1])) {
        first_.push_back(i);
        parts.push_back({face_of(order_[i]), {}, {}});
        fate[parts.back().face] = Fate::kCut;
      }
    first_.push_back(static_cast<std::uint32_t>(order_.size()));
  }

  void triangulate(CutFace& part) {
    const auto index = static_cast<std::size_t>(&part - parts.data());
    FaceArrangement face;
    for (std::size_t k = 0; k < 3; ++k) {
      face.points.push_back(make_vertex(operand_.bvh.corners(part.face)[k]));
      part.vertices.push_back(weld(operand_.mesh.triangles[part.face][k]));
    }
    std::vector<std::uint32_t> used;
    for (std::uint32_t i = first_[index]; i < first_[index + 1]; ++i) {
      const CrossSegment& s = piercing_.segments[order_[i]];
      used.push_back(s.start), used.push_back(s.end);
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t p : used) {
      face.points.push_back(piercing_.points[p]);
      part.vertices.push_back(numbering_.crossing + p);
    }
    const auto local = [&](std::uint32_t p) {
      return static_cast<std::uint32_t>(3 + (std::lower_bound(used.begin(), used.end(), p) - used.begin()));
    };
    for (std::uint32_t i = first_[index]; i < first_[index + 1]; ++i) {
      const CrossSegment& s = piercing_.segments[order_[i]];
      face.segments.push_back({local(s.start), local(s.end)});
    }
    part.triangulation = triangulate_face(face);
  }

  bool set_fate(std::uint32_t face, Fate wanted) {
    if (fate[face] == Fate::kUnknown) fate[face] = wanted, stack_.push_back(face);
    return fate[face] == wanted || fate[face] == Fate::kCut;
  }
  // From the parts along undivided edges of cut faces over all whole faces.
  bool flood() {
    bool consistent = true;
    for (const CutFace& part : parts) {
      const auto& t = part.triangulation;
      for (std::size_t i = 0; i < t.triangles.size(); ++i)
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::uint32_t a = t.triangles[i][k], b = t.triangles[i][(k + 1) % 3];
          if (a > 2 || b != (a + 1) % 3) continue;
          const Fate wanted = t.right[i] ? Fate::kKeep : Fate::kDrop;
          consistent = set_fate(operand_.twin[3 * part.face + a] / 3, wanted) && consistent;
        }
    }
    return spread() && consistent;
  }
  bool spread() {
    bool consistent = true;
    while (!stack_.empty()) {
      const std::uint32_t f = stack_.back();
      stack_.pop_back();
      for (std::uint32_t k = 0; k < 3; ++k) consistent = set_fate(operand_.twin[3 * f + k] / 3, fate[f]) && consistent;
    }
    return consistent;
  }
  // Shells that the cut does not reach: inside the other operand or not, as a whole.
  bool label_whole_shells(std::string& reason) {
    for (std::uint32_t f = 0; f < fate.size(); ++f) {
      if (fate[f] != Fate::kUnknown) continue;
      bool decided = true;
      const bool inside = inside_exact(other_, operand_.bvh.corners(f)[0], decided);
      if (!decided) {
        reason = "a shell away from the cut could not be classified";
        return false;
      }
      set_fate(f, inside == (which_ == 1) ? Fate::kKeep : Fate::kDrop);
      if (!spread()) {
        reason = "a shell away from the cut has two sides";
        return false;
      }
    }
    return true;
  }

  const CutOperand &operand_, &other_;
  std::size_t which_;
  const Piercing& piercing_;
  Numbering numbering_;
  std::vector<std::uint32_t> order_, first_, stack_;
};

// Sums six times the volumes of the tetrahedra from a fixed origin; each surface goes to its own sum.
class Assembler {
 public:
  Assembler(const CutOperand& body, const CutOperand& slab, const Piercing& piercing, const Numbering& numbering)
      : body_(body), slab_(slab), origin_(bounding_box(body.mesh).centre()) {
    positions_.resize(numbering.crossing + piercing.points.size());
    for (std::size_t i = 0; i < body.mesh.vertex_count(); ++i) positions_[i] = body.mesh.vertices[i];
    for (std::size_t i = 0; i < slab.mesh.vertex_count(); ++i) positions_[numbering.slab + i] = slab.mesh.vertices[i];
    for (std::size_t i = 0; i < piercing.points.size(); ++i)
      positions_[numbering.crossing + i] = piercing.points[i].position;
  }

  void add(const CutOperand& operand, const CutSurface& surface, bool slab) {
    std::size_t next_part = 0;
    for (std::uint32_t f = 0; f < surface.fate.size(); ++f) {
      if (surface.fate[f] != Fate::kCut) {
        const Triangle& t = operand.mesh.triangles[f];
        const Triangle w{surface.weld(t[0]), surface.weld(t[1]), surface.weld(t[2])};
        add_face(w, operand, f, surface.fate[f] == Fate::kKeep, slab, slab ? 2 : 1);
        continue;
      }
      const CutFace& part = surface.parts[next_part++];
      const auto& tri = part.triangulation;
      for (std::size_t i = 0; i < tri.triangles.size(); ++i) {
        const auto& t = tri.triangles[i];
        const Triangle w{part.vertices[t[0]], part.vertices[t[1]], part.vertices[t[2]]};
        add_face(w, operand, f, tri.right[i], slab, 0);
      }
    }
  }

  void finish(Difference& out) {
    compact();
    out.mesh = std::move(mesh_), out.touched = std::move(touched_), out.intact = std::move(intact_);
    out.body_volume = signed_volume(body_.mesh);
    out.kept_volume = (keep_[0] - keep_[1]) / 6;
    out.removed_volume = signed_volume(slab_.mesh) - (drop_[1] - drop_[0]) / 6;
    out.ok = true;
  }

 private:
  void add_face(const Triangle& w, const CutOperand& operand, std::uint32_t parent, bool keep, bool slab, char intact) {
    const Vec3 a = positions_[w[0]] - origin_, b = positions_[w[1]] - origin_, c = positions_[w[2]] - origin_;
    (keep ? keep_ : drop_)[slab] += dot(a, cross(b, c));
    if (!keep) return;
    if (intact == 0) touched_.push_back(static_cast<std::uint32_t>(mesh_.triangles.size()));
    mesh_.triangles.push_back(slab ? Triangle{w[0], w[2], w[1]} : w);
    mesh_.faces.push_back_from(operand.mesh.faces, parent);
    intact_.push_back(intact);
  }
  // Keeps the used vertices in their order.
  void compact() {
    std::vector<std::uint32_t> to(positions_.size(), kNone);
    for (const Triangle& t : mesh_.triangles)
      for (std::uint32_t v : t) to[v] = 0;
    std::uint32_t n = 0;
    for (std::size_t i = 0; i < to.size(); ++i)
      if (to[i] == 0) to[i] = n++, mesh_.vertices.push_back(positions_[i]);
    for (Triangle& t : mesh_.triangles) t = {to[t[0]], to[t[1]], to[t[2]]};
  }

  const CutOperand &body_, &slab_;
  Vec3 origin_;
  std::vector<Vec3> positions_;
  SurfaceMesh mesh_;
  std::vector<std::uint32_t> touched_;
  std::vector<char> intact_;
  std::array<Real, 2> keep_{}, drop_{};
};

}  // namespace

Difference subtract(const CutOperand& body, const CutOperand& slab, const Piercing& piercing) {
  Difference out;
  const auto bodies = static_cast<std::uint32_t>(body.mesh.vertex_count());
  const Numbering numbering{bodies, bodies + static_cast<std::uint32_t>(slab.mesh.vertex_count())};
  CutSurface outside(body, slab, 0, piercing, numbering), inside(slab, body, 1, piercing, numbering);
  if (!outside.run(out.reason) || !inside.run(out.reason)) return out;
  Assembler assembler(body, slab, piercing, numbering);
  assembler.add(body, outside, false);
  assembler.add(slab, inside, true);
  assembler.finish(out);
  return out;
}

}  // namespace sherd
