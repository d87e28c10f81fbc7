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
  // The same for a front that runs along `headings` (one a point; unit, or zero when it has none). Stress does not
  // depend on where a crack is going; a guide steers by it.
  virtual void stress_ahead(const Vec3Column& points, const Vec3Column& headings,
                            std::vector<PrincipalStress>& out) const {
    static_cast<void>(headings);
    principal_stress(points, out);
  }
};

}  // namespace sherd
