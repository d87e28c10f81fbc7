// Where cracks start (paper 6.3, algorithm 2): surface vertices whose largest principal stress exceeds the strength and
// is maximal over their 1-ring.
#pragma once
#include "engine/fracture/grow.h"
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

// Strongest first; ties by vertex index. Seeds inside the 1-ring of a stronger seed are left out.
std::vector<CrackSeed> find_seeds(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state,
                                  Real strength);
// The vertex with the largest principal stress of the surface, whatever the strength. The mesh must not be empty.
CrackSeed strongest_point(const SurfaceMesh& mesh, const SurfaceRecovery& recovery, const StressState& state);

}  // namespace sherd
