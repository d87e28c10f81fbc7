// A crack while it grows: an open, oriented, embedded triangle sheet (the crack's mid-surface) whose border is the front.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

enum class NodeState : std::uint8_t {
  kActive,    // on the front, growing
  kArrested,  // on the front, stress below the propagation strength
  kExited,    // on the front, outside the body (an end of the crack line, or past it)
  kBlocked,   // on the front, stopped by another crack or by the sheet itself
  kInterior,  // no longer on the front
};

struct CrackSheet {
  Vec3Column position;            // nodes, material space, m
  Vec3Column normal;              // unit oriented crack normal (the stress eigenvector, sign-consistent)
  std::vector<NodeState> state;   // per node
  std::vector<Triangle> triangles;
};

}  // namespace sherd
