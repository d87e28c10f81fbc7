// O4 and O5: moving front nodes through the body, and out of it. Internal to the fracture stage.
#pragma once
#include "engine/fracture/front.h"

namespace sherd {

// Where a point that left the body comes to rest: at least 0.95 overshoot from the surface, moved within the plane
// perpendicular to `normal`, or in the middle of a gap narrower than that.
Vec3 push_out(const Growth& g, Vec3 q, const Vec3& normal);

// Moves node loop[i] (a new row, or the node itself for short ways). Returns false when the sheet is in the way; or the
// way has no length; the node then stays. A node outside the body exits whatever its way. The loop's entry is replaced
// by the new node.
bool advance_node(Growth& g, FrontLoop& loop, std::size_t i, const Advance& advance);

// All nodes of all loops, in loop order. A node refused three times in a row is blocked. Returns how many moved.
int advance_front(Growth& g, const std::vector<std::vector<Advance>>& velocity);

}  // namespace sherd
