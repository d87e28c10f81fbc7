// One equation a cavity. As nu approaches 1/2 the direct equation ceases to see how much a cavity swells (the operator
// becomes singular like 1 - 2 nu, once for each cavity). Betti's theorem with the field u* = (x - c)/|x - c|^3 of a
// source of volume at a point c in the cavity, which solves Navier's equation for every nu, says it:
//   integral of u . t* = integral of t . u*,   t* = 2 mu grad(u*) n.
// Added as (A + d w^T) u = b + d beta it holds for the exact solution and removes the singularity.
#pragma once
#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/particular.h"
#include "engine/elastostatic/reconstruction.h"
#include "engine/elastostatic/rigid_modes.h"

namespace sherd {

class CavityModes {
 public:
  // A cavity whose widest ball is smaller than 0.3 of the edges around it is left out: its source would be too near.
  CavityModes(const Boundary& boundary, const Reconstruction& reconstruction, const RigidModes& rigid);
  std::size_t count() const { return modes_.size(); }
  // y += sum of d (w . x)
  void add(std::span<const Real> x, std::span<Real> y) const;
  // b += sum of d beta for a load, homogeneous part (traction less the particular one).
  void add_load(const Boundary& boundary, const Load& load, const ParticularSolution& particular, Real mu,
                std::span<Real> b) const;
  // Entry (i, j) of the sum of d w^T.
  Real entry(std::size_t i, std::size_t j) const;

 private:
  struct Mode {
    Vec3 centre;
    std::vector<Real> d, w;  // interleaved, d already divided by w . u*
  };
  std::vector<Mode> modes_;
};

}  // namespace sherd
