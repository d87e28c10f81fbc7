// One fracture event (paper algorithm 1, lines 3 to 16, for one body): load, solve, stress, seeds, cracks, cuts,
// remeshing.
#pragma once
#include <string>

#include "engine/fragment/cut.h"
#include "engine/load/surface_load.h"
#include "engine/material/scalar_field.h"
#include "engine/mesh/refit.h"
#include "engine/step/crack_record.h"
#include "engine/step/shown_field.h"
#include "engine/step/skip_counts.h"
#include "engine/step/solid.h"

namespace sherd {

// Seconds per stage; kept apart from everything that must be the same in every run.
struct EventSeconds {
  // `front`: stress at the fronts of cracks; `grow`: growth without it.
  Real assemble = 0, solve = 0, stress = 0, front = 0, grow = 0, cut = 0, remesh = 0;
};

struct FractureOptions {
  ElasticOptions elastic;
  MaterialFields fields;
  Real speed = 0.5;
  bool interior_seeds = false;  // also start cracks inside, where the stress exceeds that of the surface
  bool net_section = true;      // let the ligament of a stopped crack fail, see net_section.h
  int max_cracks = 8;
  // How often the stress is solved within one event. 1: once, all cracks follow the stress of the body before any.
  // More: a piece is cut once a round, and the pieces that still bear load are solved anew under their part of it.
  int rounds = 1;
  std::size_t max_pieces = 200;     // the body may fall into
  Real min_fragment_volume = 1e-4;  // of the scene body's volume; smaller pieces are dust
  DustRule dust = DustRule::kDrop;
  std::int32_t first_crack_id = 0;
  int generation = 0;  // of the body, for the records
  SceneSkip skip;
  bool only_solve = false;                   // start no crack: what solving would cost for a body that may not break
  std::optional<SceneField> field;           // to be made of the solve
  std::shared_ptr<const SurfaceMesh> shown;  // what is shown of the body before the event, for the field
};

struct FragmentShape {
  std::shared_ptr<const SurfaceMesh> clean;  // for stress
  std::shared_ptr<const SurfaceMesh> shown;  // with the notches of the partial cracks; same as clean without any
  std::vector<StoppedCrack> partial;
  Real edge_length = 0;                       // of the clean mesh, m
  bool was_cut = false;                       // in the last round: another piece than before
  std::shared_ptr<const SurfaceField> field;  // of `shown`, if wanted
};

// One solve of the stress.
struct SolveRecord {
  int round = 0;
  bool solved = false;
  std::string reason;  // when not solved
  KrylovResult krylov;
  std::size_t triangles = 0, panels = 0;
  std::size_t unknowns = 0, galerkin_vertices = 0;  // of the system; vertices with Petrov-Galerkin rows
  Real incompatibility = 0;                         // solver.h
  bool factored = false;                            // preconditioned by triangular factors
  bool warm = false;                                // started from earlier solutions
  Real force = 0;                                   // sizes of all forces together, N
  Real relief = 0;        // force that inertia balances, of all: 0 for a load that balances by itself
  CrackSeed strongest;    // largest principal stress on the surface in units of the strength
  std::size_t seeds = 0;  // local maxima above the strength
};

struct FractureResult {
  std::vector<SolveRecord> solves;            // of the body, then of its pieces; none for guided cracks
  bool changed = false;                       // shapes differ from the body as it was
  std::vector<FragmentShape> shapes;          // one: the body with a notch or hole; more: its fragments
  std::shared_ptr<const SurfaceField> field;  // of the body as it was shown, if wanted
  std::vector<CrackRecord> cracks;
  // m^3. before - removed - dust + remeshing = after, to rounding; `after` is of the shapes' clean meshes.
  Real volume_before = 0, removed_volume = 0, dust_volume = 0, remeshing_volume = 0, volume_after = 0;
  Real notch_volume =
      0;  // by which the shapes as shown are smaller: notches of stopped cracks, and crumbs they cut off
  std::vector<RefitReport> refits;  // of the pieces cut; one refused keeps the mesh the cut left
  std::int32_t next_crack_id = 0;
  SkipCounts skips;
  EventSeconds seconds;

  bool solved() const { return !solves.empty() && solves[0].solved; }
};

// Fills in the volumes of what the shapes are.
void measure(FractureResult& result);

// `pull`: all that pulls at the body, made for solid.mesh(), of which `mass` must be. Never throws for geometric or
// numerical trouble: an unsolved load or a failed crack leaves the body as it was and says why.
FractureResult fracture_solid(Solid& solid, const MassProperties& mass, const Elastic& material,
                              const SurfaceLoad& pull, const FractureOptions& options);

}  // namespace sherd
