// The sheet while it grows: nodes, triangles, adjacency and a spatial index, changed only by transactions that keep it
// an embedded oriented 2-manifold with border (the design's S1, S2). Internal to the fracture stage.
#pragma once
#include <limits>
#include <unordered_map>

#include "engine/fracture/crack_field.h"
#include "engine/fracture/sheet.h"

namespace sherd {

// Uniform hash grid over triangle boxes. Buckets are only looked up by key, never iterated, so results are
// deterministic.
class BoxGrid {
 public:
  explicit BoxGrid(Real cell) : inverse_cell_(1 / cell) {}
  void insert(std::uint32_t id, const Box& box);
  void remove(std::uint32_t id, const Box& box);
  // Ids whose cells overlap those of `box`, each once, in an order that means nothing.
  void query(const Box& box, std::vector<std::uint32_t>& ids) const;

 private:
  template <class F>
  void for_each_cell(const Box& box, const F& visit) const;
  Real inverse_cell_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
  mutable std::vector<std::uint32_t> seen_;  // per id: the last query that met it
  mutable std::uint32_t query_ = 0;
};

// One transaction: triangles to remove, at most one node to move, triangles to add. The caller keeps the topology right
// (directed edges used once, no pinch); geometry is what apply() judges.
inline constexpr std::int32_t kNoCrack = std::numeric_limits<std::int32_t>::min();

struct SheetEdit {
  std::vector<std::uint32_t> remove;
  std::vector<Triangle> add;
  std::uint32_t moved = kNone;
  Vec3 to;
};

class SheetMesh {
 public:
  // edge_length: h, m; clearance: least distance between sheet layers that face each other, m.
  SheetMesh(Real edge_length, Real clearance);

  void set_clearance(Real clearance) { clearance_ = clearance; }  // for edits from now on
  std::uint32_t add_node(const Vec3& position, const Vec3& normal, NodeState state);
  // Does the edit and returns true, or changes nothing and returns false when a new or moved triangle would be
  // degenerate, turned over against its nodes' normals, or would meet the rest of the sheet.
  bool apply(const SheetEdit& edit);
  bool move(std::uint32_t node, const Vec3& to);
  bool add(std::initializer_list<Triangle> triangles);

  bool has_edge(std::uint32_t a, std::uint32_t b) const;
  // The triangle with the directed edge a -> b, or kNone.
  std::uint32_t triangle_at(std::uint32_t a, std::uint32_t b) const;
  // Nodes joined to v by an edge, ascending.
  std::vector<std::uint32_t> neighbours(std::uint32_t v) const;
  // Does the sheet pass over or under node v, nearer than `reach` along its normal?
  bool has_layer(std::uint32_t v, Real reach);
  // The first triangle that runs across the plane with unit normal `plane` on the way from `from`, t in [0, length].
  bool first_hit(const Vec3& from, const Vec3& direction, Real length, const Vec3& plane, Real& t);
  // Does the sheet pass nearer than `reach` to x, along the plane?
  bool passes(const Vec3& x, Real reach, const Vec3& plane);
  // Nodes and triangles of a sheet that check_sheet() accepts; this mesh is empty.
  void load(const CrackSheet& sheet);
  // Without dead triangles and unused nodes; the order of nodes and triangles is kept. `front`: loops to translate.
  CrackSheet extract(const std::vector<std::vector<std::uint32_t>>& front) const;

  Vec3Column position, normal;
  std::vector<NodeState> state;
  std::vector<std::int32_t> met;           // of a blocked node: the crack that stopped it; kNoCrack: its own sheet
  std::vector<std::uint8_t> failures;      // refused advances in a row, per node
  std::vector<std::uint8_t> pushes;        // per node: how often it was pushed farther out after it had left the body
  std::vector<std::uint8_t> stress_known;  // `stress` belongs to the node's present position
  std::vector<PrincipalStress> stress;
  std::vector<std::uint32_t> moves;  // per node: how often it moved
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> alive;                   // per triangle
  std::vector<std::vector<std::uint32_t>> incident;  // per node: alive triangles

 private:
  struct Trial {
    Triangle nodes;
    std::array<Vec3, 3> corners;
    Vec3 normal;                  // unit
    std::array<Vec3, 3> outward;  // unit, in the plane, of edge k -> k + 1
  };
  bool make_trials(const SheetEdit& edit);
  bool trial_is_sound(Trial& trial) const;
  bool trial_is_clear(const Trial& trial, const SheetEdit& edit);
  bool lies_aside(const Trial& trial, const std::array<Vec3, 3>& corners) const;
  bool crowds(const Trial& trial, const Triangle& nodes, const std::array<Vec3, 3>& corners) const;
  bool hidden(std::uint32_t t, const SheetEdit& edit) const;
  Box box_of(std::uint32_t t) const;
  Vec3 normal_of(std::uint32_t t) const;
  std::array<Vec3, 3> corners_of(std::uint32_t t) const;
  void link(std::uint32_t t);
  void unlink(std::uint32_t t);

  Real edge_, clearance_;
  BoxGrid grid_;
  std::vector<Box> boxes_;     // per triangle
  std::vector<Trial> trials_;  // scratch of apply
  std::vector<std::uint32_t> candidates_;
};

}  // namespace sherd
