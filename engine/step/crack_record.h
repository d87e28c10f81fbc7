// What became of one crack, for stats.json.
#pragma once
#include <optional>
#include <string>

#include "engine/fracture/guide.h"
#include "engine/fracture/sheet_quality.h"

namespace sherd {

// Why a crack was tried.
enum class CrackCause { kStress, kResumed, kGuide, kInterior };

struct CrackRecord {
  std::int32_t id = 0;
  CrackCause cause = CrackCause::kStress;
  int generation = 0;  // of the body it ran through: 0 for a body of the scene
  int round = 0;       // of the event, see FractureOptions::rounds
  Vec3 seed;           // m, material space
  Real stress = 0;     // at the seed, Pa
  // "complete": through; "pierced": through, yet nothing came apart (a handle was cut); "arrested": stopped inside;
  // "rejected": no sheet could start there; "failed": no rung of the ladder gave a valid sheet and cut, or an error;
  // the body is bit-identical after the last two.
  std::string outcome, reason;
  int ladder_level = 0, steps = 0;
  int retreats = 0;                         // see GrowthResult
  std::size_t wings = 0;                    // parts beyond a handle or cavity that it left to go on by themselves
  Rungs rungs;                              // why each failed
  Real edge_length = 0;                     // of the sheet, m: the mesh's, or a finer one where a wall asks for it
  SheetQuality sheet;                       // of its triangles; empty when rejected or failed
  std::optional<GuideDeviation> off_guide;  // of a guided crack that was not refused
  Real net_section_stress = 0;              // mean tension the rest of the section would bear, Pa; 0: not asked
  Real area = 0;                            // inside the body, m^2
  Real length = 0;                          // of its trace on the surface, m
  Real removed_volume = 0;                  // from the body, m^3; 0 for a stopped crack, which is kept as a sheet
  Real dust_volume = 0;                     // of pieces too small to keep that it cut off, m^3
  // |piece before - pieces after - removed - dust| over the piece before; the exact cut keeps it at rounding.
  Real volume_error = 0;
  std::vector<std::int32_t> met;  // stopped cracks it ran into and ended at
  std::size_t fragments = 0;      // the piece it ran through fell into
};

}  // namespace sherd
