#include "engine/rigid/warm_start.h"

#include <algorithm>

namespace sherd {
namespace {

constexpr Real kSamePlace = 0.03;  // a contact within this share of the body's size is the one of the last push

bool pair_before(const WarmContact& x, const WarmContact& y) {
  return x.a != y.a ? x.a < y.a : x.b < y.b;
}

}  // namespace

void warm_start(const StepWorld& world, std::span<const Contact> contacts, Real time, std::span<ContactRow> rows) {
  const std::vector<WarmContact>& warm = world.state.warm;
  if (warm.empty()) return;
  const Real scale = time / world.state.warm_dt;
  std::vector<char> used(warm.size(), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& c = contacts[i];
    const auto [first, last] = std::equal_range(warm.begin(), warm.end(), WarmContact{c.a, c.b, {}, {}}, pair_before);
    if (first == last) continue;
    const Vec3 place = to_material(world.bodies[rows[i].a], c.point);
    const Real near = kSamePlace * world.pair_size(c);
    Real best = near * near;
    auto nearest = last;
    for (auto w = first; w != last; ++w) {
      const Real d = distance2(w->place, place);
      if (!used[static_cast<std::size_t>(w - warm.begin())] && d < best) best = d, nearest = w;
    }
    if (nearest == last) continue;
    used[static_cast<std::size_t>(nearest - warm.begin())] = 1;
    ContactRow& r = rows[i];
    r.impulse[0] = std::max(0.0, scale * dot(r.axis[0], nearest->impulse));
    for (int k = 1; k < 3; ++k) r.impulse[k] = scale * dot(r.axis[k], nearest->impulse);
    // Into the cone of this contact: a first residual below the tolerance ends the solve.
    const Real slide = std::hypot(r.impulse[1], r.impulse[2]), most = r.friction * r.impulse[0];
    if (slide > most) r.impulse[1] *= most / slide, r.impulse[2] *= most / slide;
  }
}

void keep_warm(StepWorld& world, std::span<const Contact> contacts, Real time, std::span<const ContactRow> rows) {
  RigidState& state = world.state;
  state.warm.clear();
  state.warm_dt = time;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactRow& r = rows[i];
    if (r.impulse[0] <= 0) continue;
    state.warm.push_back({contacts[i].a, contacts[i].b, to_material(world.bodies[r.a], contacts[i].point), r.total()});
  }
  std::stable_sort(state.warm.begin(), state.warm.end(), pair_before);
}

}  // namespace sherd
