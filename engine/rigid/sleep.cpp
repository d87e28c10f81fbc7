#include "engine/rigid/sleep.h"

#include <algorithm>
#include <numeric>

namespace sherd {
namespace {

constexpr int kOldEnough = 1000;  // age saturates

void wake(BodyRigidState& s) {
  s.asleep = false, s.still = 0, s.partners.clear();
}

// A sleeper leaning on an awake movable body wakes; repeated until nothing changes.
std::size_t spread_waking(std::span<const Body> bodies, RigidState& state) {
  std::map<BodyId, bool> awake;
  for (const Body& b : bodies) awake[b.id] = !b.fixed && !state.bodies.at(b.id).asleep;
  std::size_t woken = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (auto& [id, s] : state.bodies) {
      if (!s.asleep) continue;
      const bool disturbed = std::any_of(s.partners.begin(), s.partners.end(), [&](BodyId p) {
        const auto found = awake.find(p);
        return found != awake.end() && found->second;
      });
      if (disturbed) wake(s), awake[id] = true, changed = true, ++woken;
    }
  }
  return woken;
}

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

void update_state(std::span<const Body> bodies, bool ground, RigidState& state) {
  std::map<BodyId, BodyRigidState> kept;
  std::vector<BodyId> unchanged;
  for (const Body& b : bodies) {
    const auto old = state.bodies.find(b.id);
    BodyRigidState s;
    s.mesh_version = b.mesh_version;
    if (old != state.bodies.end()) {
      s = std::move(old->second);
      if (s.mesh_version == b.mesh_version)
        unchanged.push_back(b.id);
      else
        s.mesh_version = b.mesh_version, wake(s);
      if (s.asleep && (b.velocity != Vec3{} || b.angular_velocity != Vec3{} || b.pose != s.pose || b.fixed)) wake(s);
      s.age = std::min(s.age + 1, kOldEnough);
    }
    kept.emplace(b.id, std::move(s));
  }
  if (ground) unchanged.push_back(kGround);
  std::sort(unchanged.begin(), unchanged.end());
  for (auto& [id, s] : kept)
    if (s.asleep && !std::includes(unchanged.begin(), unchanged.end(), s.partners.begin(), s.partners.end())) wake(s);
  state.bodies.swap(kept);
  spread_waking(bodies, state);
}

std::size_t wake_touched(std::span<const Body> bodies, std::span<const Contact> contacts,
                         const std::vector<char>& touches, RigidState& state) {
  std::map<BodyId, const Body*> by_id;
  for (const Body& b : bodies) by_id[b.id] = &b;
  std::size_t woken = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!touches[i] || contacts[i].b == kGround) continue;
    BodyRigidState &a = state.bodies.at(contacts[i].a), &b = state.bodies.at(contacts[i].b);
    if (a.asleep == b.asleep || by_id.at(a.asleep ? contacts[i].b : contacts[i].a)->fixed) continue;
    wake(a.asleep ? a : b);
    ++woken;
  }
  return woken > 0 ? woken + spread_waking(bodies, state) : 0;
}

void put_to_sleep(std::span<Body> bodies, std::span<const Contact> contacts, const std::vector<char>& touches,
                  const std::vector<char>& still, Real dt, Real sleep_time, RigidState& state) {
  const auto count = static_cast<std::uint32_t>(bodies.size());
  std::map<BodyId, std::uint32_t> index;
  for (std::uint32_t i = 0; i < count; ++i) index[bodies[i].id] = i;
  std::vector<std::uint32_t> parent(count);
  std::iota(parent.begin(), parent.end(), 0u);
  std::vector<std::vector<BodyId>> partners(count);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!touches[c]) continue;
    const std::uint32_t a = index.at(contacts[c].a);
    partners[a].push_back(contacts[c].b);
    if (contacts[c].b == kGround) continue;
    const std::uint32_t b = index.at(contacts[c].b);
    partners[b].push_back(contacts[c].a);
    if (bodies[a].fixed || bodies[b].fixed) continue;
    const std::uint32_t ra = find_root(parent, a), rb = find_root(parent, b);
    parent[std::max(ra, rb)] = std::min(ra, rb);
  }
  std::vector<char> rested(count, 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    BodyRigidState& s = state.bodies.at(bodies[i].id);
    if (bodies[i].fixed || s.asleep) continue;
    s.still = still[i] && !partners[i].empty() ? s.still + dt : 0;
    if (s.still < sleep_time) rested[find_root(parent, i)] = 0;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    BodyRigidState& s = state.bodies.at(bodies[i].id);
    if (bodies[i].fixed || s.asleep || !rested[find_root(parent, i)]) continue;
    std::sort(partners[i].begin(), partners[i].end());
    partners[i].erase(std::unique(partners[i].begin(), partners[i].end()), partners[i].end());
    s.partners = std::move(partners[i]);
    s.asleep = true;
    s.pose = bodies[i].pose;
    bodies[i].velocity = bodies[i].angular_velocity = Vec3{};
  }
}

}  // namespace sherd
