// What a solved load offers to whoever asks for stress, whichever formulation produced it.
#pragma once
#include <span>
#include <vector>

#include "engine/stress/recovery.h"

namespace sherd {

class StressField {
 public:
  virtual ~StressField() = default;
  // Total stress per corner of the surface (SurfaceRecovery::corners()), Pa.
  virtual const std::vector<Sym3>& corner_stress() const = 0;
  // At points of faces of the solved mesh, one face each, Pa; many at once cost less than one by one.
  virtual void on_faces(const Vec3Column& points, std::span<const std::uint32_t> face, std::span<Sym3> out) const = 0;
  // At points of the closed solid, right up to the surface, Pa. Parallel.
  virtual void evaluate(const Vec3Column& points, std::vector<Sym3>& out) const = 0;

  Sym3 on_face(std::uint32_t face, const Vec3& x) const {
    Vec3Column one;
    one.push_back(x);
    Sym3 s;
    on_faces(one, {&face, 1}, {&s, 1});
    return s;
  }
};

}  // namespace sherd
