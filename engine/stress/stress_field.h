// What a solved load offers to whoever asks for stress, whichever formulation produced it.
#pragma once
#include <vector>

#include "engine/stress/recovery.h"

namespace sherd {

class StressField {
 public:
  virtual ~StressField() = default;
  // Total stress per corner of the surface (SurfaceRecovery::corners()), Pa.
  virtual const std::vector<Sym3>& corner_stress() const = 0;
  // At a point of a face of the solved mesh, Pa.
  virtual Sym3 on_face(std::uint32_t face, const Vec3& x) const = 0;
  // At points of the closed solid, right up to the surface, Pa. Parallel.
  virtual void evaluate(const Vec3Column& points, std::vector<Sym3>& out) const = 0;
};

}  // namespace sherd
