// Work that is left out because nothing in the result asks for it. Each switch can be turned off, to see that the
// result stays and what it saves; scenes/README.md says what each may change.
#pragma once
#include <array>
#include <cstddef>

namespace sherd {

enum class Skip {
  kSleep,           // moving bodies at rest
  kDistanceFields,  // making a distance field for a body nothing comes near, and again while its mesh lives
  kUnbreakable,     // solving the stress of bodies that may not break
  kLoadBounds,      // solving for a load that cannot reach the strength
  kOperators,       // assembling and preconditioning the system of a mesh again
  kWarmStart,       // iterating towards what earlier solutions say already
  kZeroTerms,       // integrating body forces that are not there
  kFarField,        // the fast multipole method where plain sums are sooner ready
  kFrontStress,     // stress at nodes of a crack that do not move
  kUploads,         // sending a mesh to the renderer that has it
};

struct SkipSwitch {
  Skip skip;
  const char* key;     // of [skip] in a scene, and in stats.json
  const char* counts;  // what is counted as done or skipped
};

inline constexpr std::array<SkipSwitch, 10> kSkipSwitches{
    {{Skip::kSleep, "sleep", "motions of a body in a step"},
     {Skip::kDistanceFields, "distance_fields", "distance fields, of a body in a step"},
     {Skip::kUnbreakable, "unbreakable", "solves of bodies that may not break"},
     {Skip::kLoadBounds, "load_bounds", "solves of bodies that may break"},
     {Skip::kOperators, "operators", "systems assembled"},
     {Skip::kWarmStart, "warm_start", "solves from zero"},
     {Skip::kZeroTerms, "zero_terms", "right-hand sides with body forces"},
     {Skip::kFarField, "far_field", "solves by the fast multipole method"},
     {Skip::kFrontStress, "front_stress", "stresses at nodes of a crack in a step"},
     {Skip::kUploads, "uploads", "meshes sent to the renderer"}}};

// Which switches are on: all, unless a scene or the command says otherwise.
struct SceneSkip {
  bool operator[](Skip s) const { return !off[static_cast<std::size_t>(s)]; }
  void set(Skip s, bool on) { off[static_cast<std::size_t>(s)] = !on; }

  std::array<bool, kSkipSwitches.size()> off{};
};

}  // namespace sherd
