// Is a mesh fine enough for its walls? Bending of a wall thinner than its elements is where boundary elements lock; the
// error depends on h / T, the local edge length over the wall thickness (engine/mesh/thickness.h), and on the method.
// Solid parts are not affected.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "engine/mesh/thickness.h"

namespace sherd {

// The largest h / T at which the rms of the surface stress errs by 5 % and by 1 % of its peak, on flat plates in
// harmonic bending with 16 to 20 elements a wavelength, as measured; 0: not reached.
struct ResolutionRule {
  const char* method;
  Real at_5_percent, at_1_percent;
};
inline constexpr ResolutionRule kCubicTestedRule{"cubic displacement, Petrov-Galerkin", 3.0, 1.3};
inline constexpr ResolutionRule kCubicCollocationRule{"cubic displacement, vertex collocation", 1.1, 0};
inline constexpr ResolutionRule kLinearCollocationRule{"linear displacement, vertex collocation", 0.6, 0};

inline constexpr std::array<Real, 6> kResolutionLimits{0.5, 1, 1.5, 2, 3, 6};

struct ResolutionReport {
  Real area = 0;                                           // of the surface, m^2
  Real wall_share = 0;                                     // of the area that is a wall
  std::array<Real, kResolutionLimits.size()> share_above;  // of the area with h / T above each limit
  Real share_above_5_percent = 0;                          // of the area with h / T above the rule's limit
  Real share_above_1_percent = 0;                          // 0 as well when the method does not reach 1 %
  Real worst = 0;                                          // largest h / T; 0 without walls
  Vec3 worst_place;                                        // m
  Real worst_edge = 0, worst_thickness = 0;                // m, there
  Real thinnest = 0;                                       // smallest T, m; 0 without walls
  Vec3 thinnest_place;                                     // m
  // The thickness all but a hundredth of the area is above, m, 0 when less than a hundredth are walls: one odd face
  // does not decide over the mesh.
  Real governing = 0;
  Real edge_for_5_percent = 0, edge_for_1_percent = 0;  // uniform edge length by the rule and `governing`, m; 0: none
  // Triangles with that edge length everywhere, and where walls ask for it only.
  Real triangles_for_5_percent = 0, triangles_for_1_percent = 0;
  Real graded_for_5_percent = 0, graded_for_1_percent = 0;
};

ResolutionReport resolution_report(const SurfaceMesh& mesh, const WallThickness& thickness,
                                   const ResolutionRule& rule = kCubicTestedRule);
ResolutionReport resolution_report(const SurfaceMesh& mesh, const ResolutionRule& rule = kCubicTestedRule);

// Empty when at most a hundredth of the area has h / T above the rule's 5 % limit; else what is too coarse, where, and
// which edge length helps. Lengths are in the mesh's units.
std::vector<std::string> resolution_warnings(const ResolutionReport& report,
                                             const ResolutionRule& rule = kCubicTestedRule);

// Some lines for a person; one JSON object with the members of ResolutionReport as keys (`share_above`: an object with
// the limits as keys).
std::string to_text(const ResolutionReport& report, const ResolutionRule& rule = kCubicTestedRule);
std::string to_json(const ResolutionReport& report, const ResolutionRule& rule = kCubicTestedRule);

}  // namespace sherd
