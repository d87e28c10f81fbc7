// Stress of the indirect formulation: the gradient of the single layer plus what balances the body force.
#pragma once
#include "engine/elastostatic/indirect.h"
#include "engine/mesh/bvh.h"
#include "engine/stress/stress_field.h"

namespace sherd {

// Keeps references to the body, recovery and bvh, which must outlive it. Measured errors in the design notes' column
// (a).
class IndirectState final : public StressField {
 public:
  // The solution must carry a density (converged or not). `particular` as in IndirectBody::solve().
  IndirectState(const IndirectBody& body, const SurfaceRecovery& recovery, const TriangleBvh& bvh, const Load& load,
                const ParticularSolution& particular, const IndirectSolution& solution);

  // Area-weighted mean of face_stress() over the corner's faces, Pa: of the cheap read-outs the best one. The known
  // traction needs no projection into it: the layer meets it at the centroids.
  const std::vector<Sym3>& corner_stress() const override { return corner_stress_; }
  // Linear interpolation of the corner stresses: the limit below has logarithms at every edge, which cost up to ten
  // times the error there.
  void on_faces(const Vec3Column& points, std::span<const std::uint32_t> face, std::span<Sym3> out) const override;
  // Blended like StressState::evaluate(): interior() within a quarter edge of the surface meets the logarithms too.
  void evaluate(const Vec3Column& points, std::vector<Sym3>& out) const override;

  // Limit from inside at the centroid of each face, Pa.
  const std::vector<Sym3>& face_stress() const { return face_stress_; }
  // Limit from inside at any point of a face; finite, but meaningless, on its edges.
  Sym3 limit(std::uint32_t face, const Vec3& x) const { return total(x, face); }
  // The layer's gradient and the body force's stress at a point off the surface, no blending.
  Sym3 interior(const Vec3& x) const { return total(x, kNone); }

 private:
  Sym3 total(const Vec3& x, std::uint32_t own) const;  // own: the face x lies on, or kNone

  const IndirectBody& body_;
  const SurfaceRecovery& recovery_;
  const TriangleBvh& bvh_;
  BodyForceField field_;
  Vec3Column density_;
  std::vector<Sym3> face_stress_, corner_stress_;  // Pa
};

}  // namespace sherd
