// The state of a run and what changes it: steps of motion, events of fracture. Simulation is its face.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/load/surface_load.h"
#include "engine/material/scalar_field.h"
#include "engine/scene/scene.h"
#include "engine/step/build_bodies.h"
#include "engine/step/stats.h"
#include "kernels/core/parallel.h"

namespace sherd {

struct World {
  static constexpr std::size_t kUnrecorded = static_cast<std::size_t>(-1);

  // A load of the scene on a body, spread over the surface it had at the start.
  struct HeldLoad {
    AppliedLoad load;
    AppliedTraction traction;
  };
  // Beside each body, in the same order.
  struct Companion {
    std::shared_ptr<Solid> solid;
    std::size_t scene_body = 0;
    std::vector<HeldLoad> loads = {};                // none once it has broken
    std::vector<bool> solved_loads = {};             // which of them acted in the last solve of this mesh
    std::size_t mesh = kUnrecorded;                  // index into RunRecord::meshes
    std::size_t last_solve = 0;                      // step, for dropping operators
    int failed_solves = 0;                           // on this mesh
    Real ratio_per_force = 0;                        // largest stress over strength that solves of this mesh gave, 1/N
    std::shared_ptr<const SurfaceField> field = {};  // of the body's mesh, from its last solve
  };
  // What belongs to a body of the scene and all its fragments.
  struct Root {
    MaterialFields fields;
    std::vector<GuideSpec> guides;  // of SceneBody::cracks
    std::vector<bool> guided;       // which of them have run
  };

  Scene scene;
  ThreadLimit threads;
  std::vector<Body> bodies;
  std::vector<Companion> companions;
  std::vector<Root> roots;  // one a scene body
  GroundPlane ground;
  RigidOptions rigid;
  ContactCache cache;
  RigidState rigid_state;
  RunRecord record;
  std::vector<Contact> contacts;
  std::size_t steps = 0;
  std::uint32_t next_id = 0;
  std::int32_t next_crack = 0;
  std::vector<std::string> pending, pending_warnings;  // messages nobody has taken yet
  Box start_box;

  World(const Scene& scene, int threads);
  void advance();
  Real time() const { return static_cast<Real>(steps) * scene.time_step; }
  // Certificates of all meshes shown now, each made once, and the balance of all volume; for stats.json.
  void certify_frame(std::size_t index);

 private:
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
  Real curvature_at(BodyId id, const Vec3& world_point);
  std::vector<BodyContact> loads_on(std::size_t i);
  std::vector<bool> acting_loads(std::size_t i) const;
  std::string cannot_break(std::size_t i) const;
  std::string too_light(std::size_t i, Real force, Real pressure) const;  // N; mean over a contact patch, Pa
  // Why body i's stress need not be solved in this step; empty with `loads` set when it must.
  std::string reason_to_skip(std::size_t i, std::vector<BodyContact>& loads);

  // What breaks.
  FractureOptions fracture_options(std::size_t i) const;
  void fracture(std::size_t i, std::vector<BodyContact>&& loads, StepRecord& step);
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
