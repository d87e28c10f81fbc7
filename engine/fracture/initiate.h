// Where cracks start (paper 6.3, algorithm 2): surface vertices whose largest principal stress exceeds the strength and
// is maximal around them. Where strength varies, stress is measured in units of it.
#pragma once
#include <span>

#include "engine/fracture/grow.h"
#include "engine/material/scalar_field.h"
#include "engine/stress/stress.h"

namespace sherd {

// The elastostatic stage behind the crack's face.
class StressCrackField final : public CrackField {
 public:
  explicit StressCrackField(const StressState& state) : state_(state) {}
  void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const override;

 private:
  const StressState& state_;
};

// One vertex for each local maximum of `value` (per vertex) above `least`, highest maximum first, ties by vertex. A
// plateau, vertices connected to the maximum and within kPlateau of it, counts as one maximum: its vertex nearest to
// the plateau's centre above `least`, so that a uniform stress starts one crack, in the middle, wherever rounding put
// the largest number.
std::vector<std::uint32_t> find_peaks(const SurfaceMesh& mesh, std::span<const Real> value, Real least);
inline constexpr Real kPlateau = 1e-3;  // relative: below what the solve resolves

// Largest stress in units of the strength first; ties by vertex index. At reentrant creases the direction (and the
// value, where larger) is that of the stress half an edge below the surface.
std::vector<CrackSeed> find_seeds(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state,
                                  const ScalarField& strength);
// The vertex with the largest principal stress of the surface in units of the strength, be it above 1 or not. The mesh
// must not be empty.
CrackSeed strongest_point(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state,
                          const ScalarField& strength);

}  // namespace sherd
