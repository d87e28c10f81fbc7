// Crack growth (paper 6.3, algorithms 2 and 3; the design's O1-O8): from a seed on the surface to a sheet that is
// complete (its whole border lies outside the body) or arrested.
#pragma once
#include <array>
#include <functional>
#include <string>

#include "engine/fracture/crack_field.h"
#include "engine/fracture/obstacles.h"
#include "engine/fracture/sheet.h"
#include "engine/material/scalar_field.h"
#include "engine/mesh/bvh.h"

namespace sherd {

struct CrackSeed {
  Vec3 position;  // on the surface (or inside), material space
  Vec3 normal;    // outward unit surface normal there; of no meaning inside
  PrincipalStress stress;
  std::uint32_t vertex = kNone;  // mesh vertex it came from
  bool interior = false;         // a slit inside the body, all of it
};

inline constexpr int kRungCount = 5;  // of the retry ladder

struct GrowthOptions {
  Real edge_length = 0;           // h: target edge of body and sheet, m
  Real propagation_strength = 0;  // Pa
  Real thickness = 0;             // t, m: of the slab that the sheet must be able to become; 0: not asked
  Real speed = 0.5;               // the paper's alpha: step in units of h at the seed's stress; clamped to 0.4 .. 0.8
  Real overshoot = 0.15;          // of h: how far past the surface an exited node is placed
  int max_steps = 0;              // 0: 4 x (bounding-box diagonal / edge_length) + 64
  int rungs = kRungCount;         // of the ladder to try, from the true field on
  // When given, they take the place of the numbers above. Borrowed: they outlive the growth.
  const ScalarField* propagation_field = nullptr;
  const ScalarField* thickness_field = nullptr;
  // Ask for the stress at every node of the sheet inside the body, at every step, though only that of a moving front is
  // used: what growth would cost without keeping it (Skip::kFrontStress).
  bool ask_everywhere = false;
  const Obstacles* obstacles = nullptr;  // nodes that reach one are blocked there: a T-junction
  // The last test of a rung of the ladder, asked with the sheet as it will be returned, complete or arrested: a text
  // refuses it with that reason and the next rung is tried. When given, it takes the place of the test that the slab
  // closes and does not meet itself.
  std::function<std::string(const CrackSheet&)> accept;
};

enum class GrowthOutcome { kComplete, kArrested, kRejectedSeed, kFailed };

// Rung 0 follows the true field; 1 .. 4 blend it more and more towards the seed's plane, the last on a finer sheet
// (O8).
struct Rungs {
  std::array<std::string, kRungCount> reason;  // why each rung failed; empty when it succeeded or was not tried
};

struct GrowthResult {
  GrowthOutcome outcome = GrowthOutcome::kFailed;
  CrackSheet sheet;
  int ladder_level = 0;  // the rung this is the result of
  int retreats = 0;  // times its front went back to steer from farther away, under more tension, or a ring was closed
  // What lies beyond a place where the crack came round a handle or cavity and met its own flank: stopped there, to be
  // resumed in the pieces once `sheet` is cut.
  std::vector<CrackSheet> wings;
  int steps = 0;
  std::size_t stresses_asked = 0;   // of the field, in all attempts
  std::size_t stresses_spared = 0;  // nodes of a sheet within the body not asked for, summed over the steps
  Real area = 0;                    // of the sheet part inside the body, m^2
  Real length = 0;                  // of the sheet's trace on the body's surface, m
  std::vector<std::int32_t>
      met;             // cracks at which nodes are blocked, ascending: once those are cut, the crack may go on
  std::string reason;  // of a rejection or failure; with ladder_level > 0 why the true field failed
  Rungs rungs;
};

// `body` must describe a valid mesh. Never throws for geometric trouble: the outcome says what happened. Deterministic.
GrowthResult grow_crack(const TriangleBvh& body, const CrackField& field, const CrackSeed& seed,
                        const GrowthOptions& options);
// The same from an arrested sheet (O13): labels the front anew and goes on. `body` is the body without this crack (the
// one the sheet was grown in); kRejectedSeed when check_sheet() refuses the sheet.
GrowthResult resume_crack(const TriangleBvh& body, const CrackField& field, const CrackSheet& sheet,
                          const GrowthOptions& options);

}  // namespace sherd
