#include "engine/rigid/step.h"

#include <algorithm>

#include "engine/rigid/solver.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr int kNewborn = 3;        // steps in which siblings do not bounce
constexpr Real kSamePlace = 0.03;  // a contact within this share of the body's size is the one of the last step
constexpr Real kTolerance = 1e-4;  // of the solve, relative to the fastest approach

// Everything of one step by body index; the ground is the motion past the last body.
struct Step {
  std::span<Body> bodies;
  const GroundPlane& ground;
  const RigidOptions& options;
  const ContactCache& cache;
  const RigidState& state;
  std::map<BodyId, std::uint32_t> index;
  std::vector<Motion> motions;   // with gravity
  std::vector<ContactRow> rows;  // one a contact
  std::vector<Real> approach;    // normal velocity before the solve, m/s
  std::vector<char> touches;     // the bodies touch, or meet within the step

  bool moves(std::uint32_t i) const { return !bodies[i].fixed && !state.bodies.at(bodies[i].id).asleep; }
  Real size(BodyId id) const { return cache.bounds(bodies[index.at(id)]).box.diagonal(); }
  Real pair_size(const Contact& c) const { return c.b == kGround ? size(c.a) : std::min(size(c.a), size(c.b)); }
};

void make_motions(Step& s) {
  s.motions.assign(s.bodies.size() + 1, {});
  for (std::uint32_t i = 0; i < s.bodies.size(); ++i) {
    if (!s.moves(i)) continue;
    const Body& b = s.bodies[i];
    SHERD_CHECK(b.mass.mass > 0 && std::isfinite(b.mass.mass), "body '{}' has mass {} kg", b.name, b.mass.mass);
    s.motions[i] = {b.velocity + s.options.gravity * s.options.dt, b.angular_velocity, 1 / b.mass.mass,
                    world_inverse_inertia(b)};
  }
}

void make_rows(Step& s, std::span<const Contact> contacts) {
  s.rows.resize(contacts.size()), s.approach.resize(contacts.size()), s.touches.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& c = contacts[i];
    ContactRow& r = s.rows[i];
    const bool plane = c.b == kGround;
    r = {};
    r.a = s.index.at(c.a), r.b = plane ? static_cast<std::uint32_t>(s.bodies.size()) : s.index.at(c.b);
    r.arm_a = c.point - s.bodies[r.a].pose.position;
    r.arm_b = plane ? Vec3{} : c.point - s.bodies[r.b].pose.position;
    r.axis[0] = c.normal;
    r.axis[1] = any_perpendicular(c.normal);
    r.axis[2] = cross(c.normal, r.axis[1]);
    r.friction =
        std::sqrt(s.bodies[r.a].material.friction * (plane ? s.ground.friction : s.bodies[r.b].material.friction));
    s.approach[i] = dot(c.normal, relative_velocity(s.motions[r.a], s.motions[r.b], r));
    s.touches[i] = c.depth >= 0 || c.depth > s.approach[i] * s.options.dt;
  }
}

bool newborn_siblings(const Step& s, const Contact& c) {
  if (c.b == kGround) return false;
  const Body &a = s.bodies[s.index.at(c.a)], &b = s.bodies[s.index.at(c.b)];
  if (a.parent != b.parent && a.parent != b.id && b.parent != a.id) return false;
  return std::min(s.state.bodies.at(a.id).age, s.state.bodies.at(b.id).age) < kNewborn;
}

Real restitution(const Step& s, const Contact& c) {
  if (newborn_siblings(s, c)) return 0;
  const Real a = s.bodies[s.index.at(c.a)].material.restitution;
  return std::max(a, c.b == kGround ? s.ground.restitution : s.bodies[s.index.at(c.b)].material.restitution);
}

bool pair_before(const WarmContact& x, const WarmContact& y) {
  return x.a != y.a ? x.a < y.a : x.b < y.b;
}

// Starts each row from the impulse of the nearest contact of the pair in the last step, each used once.
void warm_start(Step& s, std::span<const Contact> contacts) {
  const std::vector<WarmContact>& warm = s.state.warm;
  if (warm.empty()) return;
  const Real scale = s.options.dt / s.state.warm_dt;
  std::vector<char> used(warm.size(), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& c = contacts[i];
    const auto [first, last] = std::equal_range(warm.begin(), warm.end(), WarmContact{c.a, c.b, {}, {}}, pair_before);
    const Vec3 place = to_material(s.bodies[s.rows[i].a], c.point);
    const Real near = kSamePlace * s.pair_size(c);
    Real best = near * near;
    auto nearest = last;
    for (auto w = first; w != last; ++w) {
      const Real d = distance2(w->place, place);
      if (!used[static_cast<std::size_t>(w - warm.begin())] && d < best) best = d, nearest = w;
    }
    if (nearest == last) continue;
    used[static_cast<std::size_t>(nearest - warm.begin())] = 1;
    ContactRow& r = s.rows[i];
    for (int k = 0; k < 3; ++k) r.impulse[k] = scale * dot(r.axis[k], nearest->impulse);
    r.impulse[0] = std::max(0.0, r.impulse[0]);
  }
}

void keep_warm(const Step& s, std::span<const Contact> contacts, RigidState& state) {
  state.warm.clear();
  state.warm_dt = s.options.dt;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactRow& r = s.rows[i];
    if (r.impulse[0] <= 0) continue;
    state.warm.push_back({contacts[i].a, contacts[i].b, to_material(s.bodies[r.a], contacts[i].point),
                          r.axis[0] * r.impulse[0] + r.axis[1] * r.impulse[1] + r.axis[2] * r.impulse[2]});
  }
  std::stable_sort(state.warm.begin(), state.warm.end(), pair_before);
}

SolveReport solve_impact(Step& s, std::span<const Contact> contacts, std::vector<Motion>& after) {
  const RigidOptions& o = s.options;
  std::vector<Real> target(contacts.size());
  Real fastest = norm(o.gravity) * o.dt;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    fastest = std::max(fastest, -s.approach[i]);
    if (!s.touches[i])
      target[i] = contacts[i].depth / o.dt;
    else
      target[i] = -s.approach[i] > o.restitution_speed ? -s.approach[i] * restitution(s, contacts[i]) : 0;
  }
  after = s.motions;
  return solve_contacts(after, s.rows, target, o.iterations, kTolerance * fastest);
}

void solve_advance(const Step& s, std::span<const Contact> contacts, std::vector<Motion>& advance) {
  const RigidOptions& o = s.options;
  std::vector<Real> target(contacts.size());
  Real fastest = norm(o.gravity) * o.dt;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Real depth = contacts[i].depth, excess = depth - o.slop * s.pair_size(contacts[i]);
    if (depth <= 0)
      target[i] = depth / o.dt;
    else
      target[i] = std::min(o.recovery_speed, o.recovery * std::max(0.0, excess) / o.dt);
    fastest = std::max(fastest, -s.approach[i]);
  }
  advance = s.motions;
  std::vector<ContactRow> rows = s.rows;  // started from the impact's impulses: at rest both problems agree
  solve_contacts(advance, rows, target, o.iterations, kTolerance * fastest);
}

Vec3 spin_of(const Quat& q, const Mat3& inverse_inertia, const Vec3& momentum) {
  return rotate(q, inverse_inertia * rotate(conjugate(q), momentum));
}

// World angular momentum is what a free body keeps: the turn uses the spin at half the step (midpoint), the new spin
// follows from the momentum and the new orientation, which is the gyroscopic term without an explicit torque.
void move(Body& b, const Motion& after, const Motion& advance, Real dt) {
  b.pose.position += advance.v * dt;
  b.velocity = after.v;
  const Quat q = b.pose.orientation;
  const Mat3 inverse_inertia = inverse(b.mass.inertia);
  const auto momentum = [&](const Vec3& w) { return rotate(q, b.mass.inertia * rotate(conjugate(q), w)); };
  const Quat half = normalized(from_rotation_vector(advance.w * (0.5 * dt)) * q);
  const Vec3 spin = spin_of(half, inverse_inertia, momentum(advance.w));
  b.pose.orientation = normalized(from_rotation_vector(spin * dt) * q);
  b.angular_velocity = spin_of(b.pose.orientation, inverse_inertia, momentum(after.w));
}

// Detects contacts, and again when a touch woke sleepers (whose own contacts were skipped).
std::size_t detect(Step& s, ContactCache& cache, RigidState& state, std::vector<Contact>& contacts,
                   ContactStats& stats) {
  std::size_t woken = 0;
  DetectOptions d;
  d.dt = s.options.dt, d.margin = s.options.margin, d.max_contacts = s.options.max_contacts;
  std::vector<std::uint8_t> resting(s.bodies.size());
  for (;;) {
    for (std::size_t i = 0; i < s.bodies.size(); ++i) resting[i] = state.bodies.at(s.bodies[i].id).asleep ? 1 : 0;
    d.resting = resting;
    detect_contacts(s.bodies, s.ground, d, cache, contacts, stats);
    make_motions(s);
    make_rows(s, contacts);
    const std::size_t now = wake_touched(s.bodies, contacts, s.touches, state);
    if (now == 0) return woken;
    woken += now;
  }
}

// Fills in the results and drops the contacts that were only gaps.
void report_contacts(const Step& s, std::vector<Contact>& contacts, RigidStats& stats) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactRow& r = s.rows[i];
    Contact c = contacts[i];
    c.impulse = r.axis[0] * r.impulse[0] + r.axis[1] * r.impulse[1] + r.axis[2] * r.impulse[2];
    c.approach_speed = std::max(0.0, -s.approach[i]);
    stats.deepest = std::max(stats.deepest, c.depth);
    if (c.depth >= 0 || r.impulse[0] > 0) contacts[out++] = c;
  }
  contacts.resize(out);
}

}  // namespace

void rigid_step(std::span<Body> bodies, const GroundPlane& ground, const RigidOptions& options, ContactCache& cache,
                RigidState& state, std::vector<Contact>& contacts, RigidStats& stats) {
  SHERD_CHECK(options.dt > 0 && std::isfinite(options.dt), "time step {} s", options.dt);
  stats = {};
  update_state(bodies, ground.enabled, state);
  Step s{bodies, ground, options, cache, state, {}, {}, {}, {}, {}};
  for (std::uint32_t i = 0; i < bodies.size(); ++i) s.index[bodies[i].id] = i;
  stats.woken = detect(s, cache, state, contacts, stats.contact);

  warm_start(s, contacts);
  std::vector<Motion> after, advance;
  const SolveReport report = solve_impact(s, contacts, after);
  solve_advance(s, contacts, advance);
  keep_warm(s, contacts, state);
  stats.iterations = report.iterations, stats.change = report.change;
  std::vector<char> still(bodies.size(), 0);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (!s.moves(i)) continue;
    move(bodies[i], after[i], advance[i], options.dt);
    SHERD_CHECK(
        is_finite(bodies[i].pose.position) && is_finite(bodies[i].velocity) && is_finite(bodies[i].angular_velocity),
        "the motion of body '{}' is not finite", bodies[i].name);
    still[i] = norm2(options.gravity) > 0 &&
               norm(after[i].v) + norm(after[i].w) * cache.bounds(bodies[i]).radius < options.sleep_speed;
  }
  put_to_sleep(bodies, contacts, s.touches, still, options.dt, options.sleep_time, state);
  for (const auto& [id, b] : state.bodies) stats.asleep += b.asleep ? 1 : 0;
  report_contacts(s, contacts, stats);
}

}  // namespace sherd
