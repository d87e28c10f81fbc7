// A body minus a slab without a copy of the body: which faces go, which come, and how the new ones join the old. Reads
// like a mesh of body faces (0 .. F) and new faces (F ..), so that checks, clean-up and the walk to components touch
// only what they must.
#pragma once
#include <string>
#include <vector>

#include "engine/fragment/cut_body.h"
#include "engine/fragment/sparse_map.h"

namespace sherd {

struct NewFace {
  Triangle vertices;     // welded numbers: of the body, of the slab, crossings
  std::uint32_t parent;  // face of the body or of the slab it is a part of
  bool of_slab = false;  // then reversed
  bool whole = false;    // an undivided face of the slab
  bool alive = true;     // false: collapsed by clean-up
};

class Carving {
 public:
  Carving(const CutBody& body, const CutOperand& slab, const Piercing& piercing);

  // Filled by subtract():
  std::vector<NewFace> faces;          // kept parts of body faces in order, then kept faces of the slab
  std::vector<std::uint32_t> cut;      // body faces that have parts, ascending
  std::vector<std::uint32_t> dropped;  // whole body faces inside the slab, ascending
  SparseMap gone;                      // the faces of `cut` and `dropped`
  Real kept_volume = 0;                // m^3
  Real removed_volume = 0;             // slab minus (slab minus body): uses the faces that are not kept

  // Joins the new faces to each other and to the body; empty, or what is not closed.
  std::string link();

  const CutBody& body() const { return body_; }
  const CutOperand& slab() const { return slab_; }
  std::uint32_t body_faces() const { return body_faces_; }
  std::uint32_t body_vertices() const { return body_vertices_; }
  std::uint32_t vertex_count() const { return body_vertices_ + static_cast<std::uint32_t>(points_.size()); }
  std::uint32_t first_crossing() const { return first_crossing_; }
  std::uint32_t crossing_operand(std::uint32_t vertex) const { return operand_of_[vertex - first_crossing_]; }

  bool alive(std::uint32_t f) const { return f < body_faces_ ? !gone.contains(f) : faces[f - body_faces_].alive; }
  const Triangle& triangle(std::uint32_t f) const {
    return f < body_faces_ ? body_.mesh().triangles[f] : faces[f - body_faces_].vertices;
  }
  Vec3 position(std::uint32_t v) const {
    return v < body_vertices_ ? body_.mesh().vertices[v] : points_[v - body_vertices_];
  }
  std::array<Vec3, 3> corners(std::uint32_t f) const;
  // Of a directed edge 3 f + k of a face that is alive.
  std::uint32_t twin(std::uint32_t e) const;
  void join(std::uint32_t e, std::uint32_t f);  // makes them twins of each other
  // Calls visit(e) for every edge that leaves the start of edge e, in turn around it.
  template <class F>
  void around(std::uint32_t e, const F& visit) const {
    std::uint32_t i = e;
    do {
      visit(i);
      i = twin(i % 3 == 0 ? i + 2 : i - 1);
    } while (i != e);
  }

 private:
  // The body's own edge that edge `k` of new face `i` is, or kNone.
  std::uint32_t body_edge(const NewFace& face, std::uint32_t k) const;

  const CutBody& body_;
  const CutOperand& slab_;
  std::uint32_t body_faces_, body_vertices_, first_crossing_;
  std::vector<Vec3> points_;               // of the slab's vertices and the crossings
  std::vector<std::uint32_t> operand_of_;  // whose edge each crossing lies on
  std::vector<std::uint32_t> twin_;        // of the new faces' edges
  SparseMap border_;                       // twins of whole body faces' edges next to new faces
};

}  // namespace sherd
