// What a crack asks of the world: the largest principal stress and its direction at points of material space.
#pragma once
#include <vector>

#include "kernels/core/column.h"

namespace sherd {

struct PrincipalStress {
  Real value = 0;  // largest principal stress, Pa, tension positive
  Vec3 direction;  // unit eigenvector; its sign carries no meaning
};

// Implemented by the elastostatic stage, and by synthetic fields in the tests.
class CrackField {
 public:
  virtual ~CrackField() = default;
  // points: material space, inside the body; out is resized to points.size(). Thread-safe, deterministic.
  virtual void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const = 0;
};

}  // namespace sherd
