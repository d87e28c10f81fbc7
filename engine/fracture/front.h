// The working state of one growing crack and the operations of one step. Internal to the fracture stage.
// Conventions: a front loop lists its nodes in the direction of the triangles' own border edges, so the sheet lies to
// the left seen against the crack normal e and the outward direction at a node is tangent x e.
#pragma once
#include "engine/fracture/grow.h"
#include "engine/fracture/sheet_mesh.h"

namespace sherd {

using FrontLoop = std::vector<std::uint32_t>;

// Another crack that grows in the same body at the same time.
struct Rival {
  SheetMesh* sheet;    // never null
  std::int32_t crack;  // its number in GrowthResult::met
  bool stronger;       // where both grow in one plane, the weaker one gives way
};

struct Growth {
  Growth(const TriangleBvh& body_, const CrackField& field_, const GrowthOptions& options_, Real edge, Real overshoot_);

  // Forgets everything that grew and takes `sheet`, which check_sheet() accepts.
  void restart(const CrackSheet& from);

  const TriangleBvh& body;
  const CrackField& field;
  GrowthOptions options;
  Real h;          // edge length of this attempt, m
  Real overshoot;  // how far past the surface an exited node lies, m
  Real blend = 0;  // 0: the field's crack normal; 1: the seed's (the ladder's lambda)
  // Of h: fronts that face each other closer than the range bend towards each other, the more the nearer; below the
  // second distance they head straight for each other.
  Real steer_range = 9, steer_full = 1.5;
  bool steered = false;     // some front did
  bool to_borders = false;  // and they bend towards places in sight where the crack has left the body, too
  bool relaxed = false;     // see relax()
  int tension = 1;          // passes of smoothing of the crack normals along the front in each step
  std::vector<Rival> rivals;
  Vec3 seed_normal;
  Real reference_stress = 0;  // Pa, the stress that gives the nominal step length
  SheetMesh sheet;
  std::vector<FrontLoop> loops;
  std::size_t stresses_asked = 0, stresses_spared = 0;  // of GrowthResult

  // What is_clear() found, per node pair, while neither moves: the same border edges are asked in every step.
  struct Clear {
    std::uint32_t moves_a = kNone, moves_b = kNone;
    bool clear = false;
  };
  mutable std::unordered_map<std::uint64_t, Clear> clear;
};

// What a node wants to do in this step.
struct Advance {
  Vec3 direction;   // unit, in the crack plane, away from the sheet
  Real length = 0;  // m; 0 for a node that stays
};

inline bool is_exited(const Growth& g, std::uint32_t v) {
  return g.sheet.state[v] == NodeState::kExited;
}
// Unit in-plane bisector pointing off the sheet at node b between its loop neighbours a and c; zero when undefined.
Vec3 outward_direction(const Growth& g, std::uint32_t a, std::uint32_t b, std::uint32_t c);
// Does the segment between two nodes miss the body?
bool is_clear(const Growth& g, std::uint32_t a, std::uint32_t b);
// An edge of the front that needs no more growth: both nodes exited and nothing of the body between them.
bool is_dead(const Growth& g, std::uint32_t a, std::uint32_t b);

// Does the stress last asked for at a node reach the propagation strength there?
bool exceeds_strength(const Growth& g, std::uint32_t v);
// O2: asks the field once for all front nodes whose stress is not known; sets states and, where the crack goes on,
// crack normals. A stopped node that lies outside the body (in a piece cut off since) is let go on, to exit.
void label_front(Growth& g);
// O3: direction and length for every loop's nodes, facing fronts steered towards each other.
std::vector<std::vector<Advance>> front_velocity(Growth& g);
// For fronts that have come to a stand at their own sheet: layers may come as near as their slab allows, wide notches
// close, normals are those of the sheet, and blocked nodes try again.
void relax(Growth& g);
// O6 and O7, up to two passes. Returns whether anything changed.
bool remesh_front(Growth& g);
// Border-edge bridges, ears and fills (O7). Returns whether anything changed.
bool merge_fronts(Growth& g);

}  // namespace sherd
