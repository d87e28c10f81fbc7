// One fracture event (paper algorithm 1, lines 3 to 16, for one body): load, solve, stress, seeds, cracks, cuts,
// remeshing.
#pragma once
#include <span>
#include <string>

#include "engine/fracture/grow.h"
#include "engine/fragment/cut.h"
#include "engine/load/surface_load.h"
#include "engine/step/solid.h"

namespace sherd {

struct CrackRecord {
  std::int32_t id = 0;
  bool resumed = false;  // grown on from an earlier, stopped crack
  Vec3 seed;             // m, material space
  Real stress = 0;       // at the seed, Pa
  std::string outcome;   // "complete", "arrested", "rejected", "failed", "cut refused"
  std::string reason;
  int ladder_level = 0, steps = 0;
  Real net_section_stress = 0;  // mean tension the rest of the section would bear, Pa; 0: not asked
  Real area = 0;                // inside the body, m^2
  Real removed_volume = 0;      // m^3, thickness times area
  std::size_t fragments = 0;    // the piece it ran through fell into
};

// Seconds per stage; kept apart from everything that must be the same in every run.
struct EventSeconds {
  Real assemble = 0, solve = 0, stress = 0, grow = 0, cut = 0, remesh = 0;
};

struct FractureOptions {
  ElasticOptions elastic;
  Real thickness = 0;             // crack thickness, m
  Real strength = 0;              // initiation, Pa
  Real propagation_strength = 0;  // Pa
  Real speed = 0.5;
  bool net_section = true;  // let the ligament of a stopped crack fail, see net_section.h
  int max_cracks = 8;
  std::size_t max_pieces = 200;     // the body may fall into
  Real min_fragment_volume = 1e-4;  // of the scene body's volume
  std::int32_t first_crack_id = 0;
};

struct FragmentShape {
  std::shared_ptr<const SurfaceMesh> clean;  // for stress
  std::shared_ptr<const SurfaceMesh> shown;  // with the notches of the partial cracks; same as clean without any
  std::vector<CrackSheet> partial;
};

struct FractureResult {
  // Of the solve:
  bool solved = false;
  std::string reason;  // when not solved
  KrylovResult krylov;
  std::size_t triangles = 0, panels = 0;
  std::size_t unknowns = 0, galerkin_vertices = 0;  // of the system; vertices with Petrov-Galerkin rows
  Real incompatibility = 0;  // solver.h
  bool factored = false;     // preconditioned by triangular factors
  CrackSeed strongest;    // largest principal stress on the surface
  std::size_t seeds = 0;  // local maxima above the strength
  // Of the fracture:
  bool changed = false;               // shapes differ from the body as it was
  std::vector<FragmentShape> shapes;  // one: the body with a notch or hole; more: its fragments
  std::vector<CrackRecord> cracks;
  Real volume_before = 0, volume_after = 0, removed_volume = 0, dust_volume = 0;  // m^3, before remeshing
  Real remeshed_volume = 0;                                                       // of the shapes after remeshing, m^3
  std::size_t remesh_refused = 0;
  EventSeconds seconds;
};

// contacts: the body's contact forces in material space; omega: angular velocity, material axes. Never throws for
// geometric or numerical trouble: an unsolved load or a failed crack leaves the body as it was and says why.
FractureResult fracture_solid(Solid& solid, const MassProperties& clean_mass, const Elastic& material,
                              std::span<const BodyContact> contacts, const Vec3& omega, const FractureOptions& options);

}  // namespace sherd
