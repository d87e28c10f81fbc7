#include "engine/fragment/difference.h"

#include <algorithm>
#include <numeric>

#include "engine/fragment/face_triangulation.h"
#include "kernels/core/fault.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

enum Fate : std::uint32_t { kKeep, kDrop, kCut };

struct CutFace {
  std::uint32_t face;
  std::vector<std::uint32_t> vertices;  // of the arrangement's points, in the welded numbering
  FaceTriangulation triangulation;      // right of the cut is kept: outside the slab, inside the body
};

// One operand cut along the segments: which whole faces go or stay, and the parts of the others.
class CutSurface {
 public:
  // which: 0 the body, 1 the slab; shift: of its vertices in the welded numbering.
  CutSurface(const CutOperand& operand, std::size_t which, const Piercing& piercing, std::uint32_t shift,
             std::uint32_t first_crossing)
      : operand_(operand), which_(which), piercing_(piercing), shift_(shift), first_crossing_(first_crossing) {}

  std::string triangulate() {
    gather();
    parallel_for(parts.size(), 16, [&](std::size_t i) { triangulate(parts[i], i); });
    for (const CutFace& c : parts)
      if (!c.triangulation.ok) return c.triangulation.reason;
    return {};
  }

  // From the parts along undivided edges of cut faces over whole faces: all of them, or only over those that go (what
  // stays of a body has no end, but a contradiction shows where the other flood meets a seed of this one).
  bool flood(bool only_dropped) {
    only_dropped_ = only_dropped;
    bool consistent = true;
    for (const CutFace& part : parts) {
      const auto& t = part.triangulation;
      for (std::size_t i = 0; i < t.triangles.size(); ++i)
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::uint32_t a = t.triangles[i][k], b = t.triangles[i][(k + 1) % 3];
          if (a > 2 || b != (a + 1) % 3) continue;
          const Fate wanted = t.right[i] ? kKeep : kDrop;
          consistent = set_fate(operand_.twin[3 * part.face + a] / 3, wanted) && consistent;
        }
    }
    return spread() && consistent;
  }
  // A shell that the cut does not reach, as a whole.
  void decide_shell(std::uint32_t face, const CutOperand& other, std::string& reason) {
    bool decided = true;
    const bool inside = inside_exact(other, operand_.corners(face)[0], decided);
    if (!decided) reason = "a shell away from the cut could not be classified";
    if (!set_fate(face, inside == (which_ == 1) ? kKeep : kDrop) || !spread())
      reason = "a shell away from the cut has two sides";
  }

  bool known(std::uint32_t face) const { return fate_.contains(face); }
  std::uint32_t fate(std::uint32_t face) const { return fate_[face]; }
  std::uint32_t weld(std::uint32_t vertex) const { return shift_ + vertex; }

  std::vector<CutFace> parts;          // ascending by face
  std::vector<std::uint32_t> dropped;  // whole faces that go, in no order

 private:
  // Cut faces with their segments, in order.
  void gather() {
    order_.resize(piercing_.segments.size());
    std::iota(order_.begin(), order_.end(), 0u);
    const auto face_of = [&](std::uint32_t s) { return piercing_.segments[s].face[which_]; };
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return face_of(a) < face_of(b); });
    for (std::uint32_t i = 0; i < order_.size(); ++i)
      if (i == 0 || face_of(order_[i]) != face_of(order_[i - 1])) {
        first_.push_back(i);
        parts.push_back({face_of(order_[i]), {}, {}});
        fate_.set(parts.back().face, kCut);
      }
    first_.push_back(static_cast<std::uint32_t>(order_.size()));
  }

  void triangulate(CutFace& part, std::size_t index) const {
    FaceArrangement face;
    for (std::size_t k = 0; k < 3; ++k) {
      face.points.push_back(make_vertex(operand_.corners(part.face)[k]));
      face.edges.push_back(static_cast<std::uint8_t>(1u << k | 1u << (k + 2) % 3));
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
      face.edges.push_back(edge_bit(part.face, piercing_.crossings[p]));
      part.vertices.push_back(first_crossing_ + p);
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

  // Of the face's edge that the crossing lies on; 0 for one inside the face.
  std::uint8_t edge_bit(std::uint32_t face, const Crossing& c) const {
    for (std::uint32_t k = 0; k < 3; ++k)
      if (c.edge_operand == which_ && operand_.edge_id(3 * face + k) == c.edge)
        return static_cast<std::uint8_t>(1u << k);
    return 0;
  }

  bool set_fate(std::uint32_t face, Fate wanted) {
    if (fate_.insert(face, wanted)) {
      if (wanted == kDrop) dropped.push_back(face);
      if (wanted == kDrop || !only_dropped_) stack_.push_back(face);
    }
    return fate_[face] == wanted || fate_[face] == kCut;
  }
  bool spread() {
    bool consistent = true;
    while (!stack_.empty()) {
      const std::uint32_t f = stack_.back();
      stack_.pop_back();
      const auto own = static_cast<Fate>(fate_[f]);
      for (std::uint32_t k = 0; k < 3; ++k) consistent = set_fate(operand_.twin[3 * f + k] / 3, own) && consistent;
    }
    return consistent;
  }

  const CutOperand& operand_;
  std::size_t which_;
  const Piercing& piercing_;
  std::uint32_t shift_, first_crossing_;
  bool only_dropped_ = false;
  SparseMap fate_;
  std::vector<std::uint32_t> order_, first_, stack_;
};

// Sides of all faces of both surfaces, or why they contradict each other.
std::string decide(const CutBody& body, const CutOperand& slab, CutSurface& outside, CutSurface& inside) {
  if (!outside.flood(true) || !inside.flood(false)) return "the sides of the cut contradict each other";
  std::vector<char> reached(body.shells().size(), 0);
  for (const CutFace& part : outside.parts) reached[body.shell_of(part.face)] = 1;
  std::string reason;
  for (std::size_t s = 0; s < reached.size(); ++s)
    if (!reached[s]) outside.decide_shell(body.shells()[s].face, slab, reason);
  for (std::uint32_t f = 0; f < slab.mesh.triangle_count(); ++f)
    if (!inside.known(f)) inside.decide_shell(f, body.operand(), reason);
  return reason;
}

// Collects the new faces and the volumes on both sides, from an origin at the cut for the sake of rounding.
class Assembler {
 public:
  explicit Assembler(Carving& carving) : out_(carving), origin_(carving.slab().bvh.box().centre()) {}

  void add_parts(const CutFace& part, bool of_slab) {
    const auto& tri = part.triangulation;
    for (std::size_t i = 0; i < tri.triangles.size(); ++i) {
      const auto& t = tri.triangles[i];
      add({part.vertices[t[0]], part.vertices[t[1]], part.vertices[t[2]]}, part.face, tri.right[i], of_slab, false);
    }
  }
  void add_whole(const CutSurface& surface, std::uint32_t f) {
    const Triangle& t = out_.slab().mesh.triangles[f];
    add({surface.weld(t[0]), surface.weld(t[1]), surface.weld(t[2])}, f, surface.fate(f) == kKeep, true, true);
  }
  // A body face that goes: whole, or for its parts.
  void remove(std::uint32_t f, bool whole) {
    const Real v = corner_volume6(out_.body().operand().corners(f), origin_);
    before_ += v;
    if (whole) drop_[0] += v;
    out_.gone.insert(f, 1);
  }
  void finish() {
    Real slab = 0;
    for (std::uint32_t f = 0; f < out_.slab().mesh.triangle_count(); ++f)
      slab += corner_volume6(out_.slab().corners(f), origin_);
    out_.kept_volume = out_.body().volume() + (keep_[0] - before_ - keep_[1]) / 6;
    out_.removed_volume = (slab - drop_[1] + drop_[0]) / 6;
  }

 private:
  void add(const Triangle& t, std::uint32_t parent, bool keep, bool of_slab, bool whole) {
    const Real v = corner_volume6({out_.position(t[0]), out_.position(t[1]), out_.position(t[2])}, origin_);
    (keep ? keep_ : drop_)[of_slab] += v;
    if (keep) out_.faces.push_back({of_slab ? Triangle{t[0], t[2], t[1]} : t, parent, of_slab, whole});
  }

  Carving& out_;
  Vec3 origin_;
  Real before_ = 0;
  std::array<Real, 2> keep_{}, drop_{};
};

}  // namespace

std::string subtract(const Piercing& piercing, Carving& carving) {
  const CutBody& body = carving.body();
  const CutOperand& slab = carving.slab();
  CutSurface outside(body.operand(), 0, piercing, 0, carving.first_crossing());
  CutSurface inside(slab, 1, piercing, carving.body_vertices(), carving.first_crossing());
  fault_point("cut.triangulate");
  for (CutSurface* surface : {&outside, &inside})
    if (std::string text = surface->triangulate(); !text.empty()) return text;
  fault_point("cut.classify");
  if (std::string text = decide(body, slab, outside, inside); !text.empty()) return text;
  fault_point("cut.assemble");
  Assembler assembler(carving);
  std::sort(outside.dropped.begin(), outside.dropped.end());
  for (const CutFace& part : outside.parts) {
    carving.cut.push_back(part.face);
    assembler.remove(part.face, false);
    assembler.add_parts(part, false);
  }
  for (const std::uint32_t f : outside.dropped) assembler.remove(f, true);
  carving.dropped = std::move(outside.dropped);
  std::size_t next = 0;
  for (std::uint32_t f = 0; f < slab.mesh.triangle_count(); ++f) {
    if (inside.fate(f) == kCut) {
      assembler.add_parts(inside.parts[next++], true);
    } else {
      assembler.add_whole(inside, f);
    }
  }
  assembler.finish();
  fault_point("cut.weld");
  return carving.link();
}

}  // namespace sherd
