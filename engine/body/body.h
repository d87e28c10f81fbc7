// A rigid body and the pose that places its material space in the world.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "engine/body/mass.h"
#include "engine/body/pose.h"
#include "engine/material/material.h"
#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct BodyId {
  std::uint32_t value = 0xFFFFFFFFu;
  friend bool operator==(BodyId, BodyId) = default;
  friend auto operator<=>(BodyId, BodyId) = default;
};
constexpr BodyId kGround{0xFFFFFFFEu};  // the ground plane as a contact partner: infinite mass, no mesh

// Fragments keep the material space of the body they come from, so a crack can be shown in it and stresses compare.
struct Body {
  BodyId id;         // never reused in a run
  BodyId parent;     // the body it broke off, or its own id for a body of the scene
  std::string name;  // scene name, fragments append _0, _1, ...
  std::shared_ptr<const SurfaceMesh>
      mesh;                        // material space, metres; shared with frames, replaced when the shape changes
  std::uint32_t mesh_version = 0;  // raised when mesh is replaced
  MassProperties mass;             // of `mesh` with `density`, about the centre of mass, material axes
  Real density = 0;                // kg/m^3; a fragment's is scaled so that fracture conserves mass
  Material material;
  Pose pose;              // world = pose.orientation * (x - mass.centre) + pose.position
  Vec3 velocity;          // of the centre of mass, m/s, world
  Vec3 angular_velocity;  // rad/s, world
  bool fixed = false;     // infinite mass, never moves, never breaks
  bool breakable = true;
  int generation = 0;  // 0 for a body of the scene, parent's + 1 for a fragment
};

inline Vec3 to_world(const Body& b, const Vec3& x) {
  return rotate(b.pose.orientation, x - b.mass.centre) + b.pose.position;
}
inline Vec3 to_material(const Body& b, const Vec3& w) {
  return rotate(conjugate(b.pose.orientation), w - b.pose.position) + b.mass.centre;
}
inline Vec3 velocity_at(const Body& b, const Vec3& world_point) {
  return b.velocity + cross(b.angular_velocity, world_point - b.pose.position);
}
// Inverse inertia tensor in world axes; zero for a fixed body.
Mat3 world_inverse_inertia(const Body& b);
Mat3 world_inertia(const Body& b);

}  // namespace sherd
