// A run and what changes it: steps of motion, events of fracture. Simulation is its face.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/material/scalar_field.h"
#include "engine/scene/scene.h"
#include "engine/step/build_bodies.h"
#include "engine/step/run_state.h"
#include "kernels/core/parallel.h"

namespace sherd {

struct World : RunState {
  // What belongs to a body of the scene and all its fragments.
  struct Root {
    MaterialFields fields;
    std::vector<GuideSpec> guides;  // of SceneBody::cracks
  };

  Scene scene;
  ThreadLimit threads;
  std::vector<Root> roots;  // one a scene body
  GroundPlane ground;
  RigidOptions rigid;
  ContactCache cache;
  Box start_box;

  // Loads and prepares all bodies.
  World(const Scene& scene, int threads);
  // Before the first step of a run that is not restored: the guided cracks of time 0.
  void start();
  void advance();
  // The state between two steps, written or read. Reading takes it into a World fresh from its constructor with the
  // scene it was written from; ArchiveError when it does not fit, InputError when the bodies come out otherwise.
  void keep(Archive& a);
  Real time() const { return static_cast<Real>(steps) * scene.time_step; }
  // Certificates of all meshes shown now, each made once, and the balance of all volume; for stats.json.
  void certify_frame(std::size_t index);

 private:
  void move_bodies(StepRecord& step);
  // Of the bodies, at the start.
  void add_body(std::size_t scene_body);
  // A mesh of several solids becomes as many bodies: nothing holds them together.
  void add_solids(const BuiltBody& built, std::size_t scene_body, const std::vector<HeldLoad>& loads);
  Box world_box() const;

  std::size_t index_of(BodyId id) const;
  // Measures body i's mesh against its walls, once a mesh.
  const MeshRecord& record_mesh(std::size_t i);

  // What pulls.
  ContactLoadOptions load_options() const;
  Real curvature_at(BodyId id, const Vec3& point);  // in material space
  std::vector<BodyContact> loads_on(std::size_t i);
  std::vector<bool> acting_loads(std::size_t i) const;
  std::string cannot_break(std::size_t i) const;
  Real needed_tension(std::size_t i) const;  // Pa, for anything to happen
  Real held_tension(std::size_t i) const;    // Pa, what the scene's loads add to contacts
  BoundedLoad spin_of(std::size_t i) const;  // a load of no contacts
  // Whether contacts of `force` (N) together and `pressure` (Pa) at most, or these contacts, cannot break the body.
  bool too_light(std::size_t i, Real force, Real pressure) const;
  bool too_light(std::size_t i, const std::vector<BodyContact>& loads) const;
  // What is to be done about body i in this step.
  struct Due {
    BodyId id;
    std::string skipped;             // why its stress need not be solved; empty: it must
    bool only_solve = false;         // for the cost alone: it may not break (Skip::kUnbreakable is off)
    std::vector<BodyContact> loads;  // when it must
  };
  Due due(std::size_t i);

  // What breaks.
  FractureOptions fracture_options(std::size_t i) const;
  SurfaceLoad pull_on(std::size_t i, std::span<const BodyContact> loads) const;
  void fracture(Due&& due, StepRecord& step);
  void only_solve(const Due& due);
  void remember(std::size_t i, const EventRecord& event, const SolveRecord& solve);
  // Guided cracks whose time has come, in all that is left of their body.
  void run_guides(StepRecord& step);
  void guide(std::size_t i, std::size_t crack, StepRecord& step);
  // Counts, applies and records the event of body i.
  void take(std::size_t i, EventRecord&& event, StepRecord& step);
  void report(const EventRecord& event);
  void apply_shapes(std::size_t i, FractureResult& result, EventRecord& event);
  void limit_operators();
};

}  // namespace sherd
