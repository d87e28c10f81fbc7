// Solves an exact case with the public faces of the engine and measures the error of its stress.
#pragma once
#include <memory>

#include "engine/stress/indirect_state.h"
#include "engine/stress/stress.h"
#include "tools/exact/case.h"

namespace sherd::exact {

enum class Formulation { kDirect, kIndirect };
std::string_view to_string(Formulation formulation);

struct SolveOptions {
  Formulation formulation = Formulation::kDirect;
  ElasticOptions elastic;  // its Krylov tolerance and memory limit also hold for the indirect formulation
  KrylovMethod indirect_method = KrylovMethod::kBicgstab;
  RecoveryOptions recovery;
  TractionDetail traction = TractionDetail::kQuadratic;
};

struct StageSeconds {
  double prepare = 0;   // search tree, recovery rows
  double assemble = 0;  // operator and preconditioner
  double solve = 0;
  double stress = 0;  // at all corners
  double total() const { return prepare + assemble + solve + stress; }
};

// Everything a stress field refers to, kept together. Not copyable: the parts refer to each other.
struct Solved {
  bool ok = false;
  std::string reason;  // when not ok
  SurfaceMesh mesh;
  std::unique_ptr<TriangleBvh> bvh;
  std::unique_ptr<SurfaceRecovery> recovery;
  std::unique_ptr<ElasticBody> body;       // direct
  std::unique_ptr<IndirectBody> indirect;  // indirect
  std::unique_ptr<StressField> field;
  std::size_t unknowns = 0;
  KrylovResult krylov;
  StageSeconds seconds;
  double peak_megabytes = 0;  // largest resident memory of the process during the solve
};
Solved solve(const SurfaceMesh& mesh, const Elastic& material, const Load& load, const SolveOptions& options);
inline Solved solve(const ExactCase& c, const SolveOptions& options) {
  return solve(c.mesh, c.material, make_load(c, options.traction), options);
}

// Error of the largest principal stress relative to the case's peak; not weighted by area.
struct StressError {
  Real rms = 0, max = 0;
  std::size_t count = 0;
};
struct SurfaceError {
  StressError all;   // every corner: (vertex, smooth group)
  StressError free;  // without the corners at sharp edges whose own faces are loaded, as in the design notes
};
SurfaceError surface_error(const ExactCase& c, const Solved& solved);

// The same for the recovery alone, fed with the exact displacement and traction: what no solver can fall below.
SurfaceError recovery_floor(const ExactCase& c, const Solved& solved);

// At `count` points a given depth below the surface, in units of the edge of the equilateral triangle with the area of
// the face above: random faces (uniform over those with |centroid| <= within), random places on them. Points nearer to
// another part of the surface are not counted; points outside of the true solid (facets of a cavity stand out of its
// wall) are compared with its nearest point.
StressError interior_error(const ExactCase& c, const Solved& solved, Real depth, std::size_t count,
                           Real within = 1e300);

}  // namespace sherd::exact
