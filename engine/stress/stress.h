// The stress stage: from a solved load to stress at surface vertices and at any point inside (paper 4.3, last
// paragraph).
#pragma once
#include "engine/elastostatic/solver.h"
#include "engine/mesh/bvh.h"
#include "engine/stress/load_gradients.h"
#include "engine/stress/somigliana.h"
#include "engine/stress/stress_field.h"

namespace sherd {

// Stress of one solution; keeps references to the body, recovery and bvh, which must outlive it.
class StressState final : public StressField {
 public:
  StressState(const ElasticBody& body, const SurfaceRecovery& recovery, const TriangleBvh& bvh, const Load& load,
              const ParticularSolution& particular, const ElasticSolution& solution);

  // Total stress per surface corner (SurfaceRecovery::corners()), Pa.
  const std::vector<Sym3>& corner_stress() const override { return corner_stress_; }
  // Per vertex: the corner with the largest principal stress.
  std::uint32_t worst_corner(std::uint32_t vertex) const { return worst_corner_[vertex]; }
  // Total displacement per vertex up to a rigid motion, m.
  const Vec3Column& displacement() const { return displacement_; }

  // Total stress at points of the closed solid: Somigliana's gradient below 0.03 local edge lengths, blended
  // linearly into the surface value above. Points outside get the value of the closest surface point. Parallel.
  void evaluate(const Vec3Column& points, std::vector<Sym3>& out) const override;
  // Somigliana's gradient alone: any point inside, no blending; outside it gives the particular solution alone.
  Sym3 interior(const Vec3& x) const;
  // Stress of the flat face: Somigliana's gradient in the limit from inside, with the known traction on the face.
  void on_faces(const Vec3Column& points, std::span<const std::uint32_t> face, std::span<Sym3> out) const override;

 private:
  // Of the homogeneous problem at x; `face`: the face x lies on, for the limit from inside, or kNone.
  void displacement_gradients(const Vec3Column& x, std::span<const std::uint32_t> face, std::span<Mat3> out) const;
  // Where on_faces() asks for the gradient, and what it makes of it.
  Vec3 asked_on_face(std::uint32_t face, const Vec3& x) const;
  Sym3 stress_on_face(std::uint32_t face, const Vec3& x, const Mat3& gradient) const;

  const ElasticBody& body_;
  const SurfaceRecovery& recovery_;
  const TriangleBvh& bvh_;
  ParticularSolution particular_;
  Vec3Column displacement_;
  std::vector<Sym3> corner_stress_;
  std::vector<std::uint32_t> worst_corner_;
  std::vector<ElementField> elements_;  // per triangle
  std::unique_ptr<Somigliana> somigliana_;
  Load patch_load_;  // the contact patches alone
  LoadGradients load_gradients_;
};

}  // namespace sherd
