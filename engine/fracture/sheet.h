// A crack while it grows: an open, oriented, embedded triangle sheet (the crack's mid-surface) whose border is the
// front.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/mesh/bvh.h"

namespace sherd {

enum class NodeState : std::uint8_t {
  kActive,    // on the front, growing
  kArrested,  // on the front, stress below the propagation strength
  kExited,    // on the front, outside the body (an end of the crack line, or past it)
  kBlocked,   // on the front, stopped by another crack or by the sheet itself
  kInterior,  // no longer on the front
};

struct CrackSheet {
  Vec3Column position;           // nodes, material space, m
  Vec3Column normal;             // unit oriented crack normal (the stress eigenvector, sign-consistent)
  std::vector<NodeState> state;  // per node
  std::vector<Triangle> triangles;
  // For resume_crack: the largest principal stress at the seed (Pa) and the seed's crack normal (unit); the border's
  // loops in the order in which growth visits them (border_loops() when empty); the sheet as it was when its last node
  // stopped, before what is done to a border that stays and to the inside. Growth goes on from there, so that a crack
  // that stops for a while ends as if it had not.
  Real reference_stress = 0;
  Vec3 seed_normal;
  std::vector<std::vector<std::uint32_t>> front;
  std::shared_ptr<const CrackSheet> stopped;
};

// Border loops of a sheet, each as nodes in the direction of the triangles' own border edges (the sheet lies to the
// left seen against the crack normal), in order of their smallest node. Empty when the border is not a set of simple
// loops.
std::vector<std::vector<std::uint32_t>> border_loops(const CrackSheet& sheet);

// The sheet's invariants: indices and coordinates valid, oriented 2-manifold with border without pinch nodes, no
// degenerate triangle, no self-intersection, `front` the border. Returns the first violation in words, or an empty
// string.
std::string check_sheet(const CrackSheet& sheet);
// All of them but the self-intersections.
std::string check_topology(const CrackSheet& sheet);

// The part of a sheet inside the body.
struct SheetExtent {
  Real area = 0;   // m^2
  Real trace = 0;  // length of the line where the sheet meets the body's surface, m
};
// Triangles that cross the surface are divided in four (in 4^5 at the body's sharp edges), then clipped by the straight
// line between the crossings of their edges: exact where body and sheet are flat, an error of the area of
// (edge / 2)^2 / (8 curvature radius) per length of the crack's outline elsewhere.
SheetExtent extent_inside(const CrackSheet& sheet, const TriangleBvh& body);
inline Real area_inside(const CrackSheet& sheet, const TriangleBvh& body) {
  return extent_inside(sheet, body).area;
}

}  // namespace sherd
