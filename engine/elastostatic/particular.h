// Polynomial particular solutions of div sigma + b = 0 for b(x) = b0 + B (x - origin): exact, free, and without the
// volume or Newton potential the paper uses (its eq. 4). Derived in closed form and checked symbolically: uniform,
// antisymmetric and symmetric part of B separately.
#pragma once
#include "engine/load/load.h"
#include "kernels/core/symmetric.h"
#include "kernels/fundamental/elastic.h"

namespace sherd {

class ParticularSolution {
 public:
  // `uniform`: a constant stress to add, Pa, with the displacement strain (x - origin).
  ParticularSolution(const BodyForce& force, const Elastic& material, const Sym3& uniform = {});
  Vec3 displacement(const Vec3& x) const;  // m
  Sym3 stress(const Vec3& x) const;        // Pa
  bool zero() const { return zero_; }

 private:
  BodyForce force_;
  Elastic material_;
  Mat3 symmetric_, antisymmetric_, strain_;
  Sym3 uniform_;
  bool zero_;
};

}  // namespace sherd
