#include "engine/rigid/part.h"

#include <algorithm>

#include "engine/contact/free_time.h"
#include "engine/rigid/free_motion.h"
#include "engine/rigid/recover.h"
#include "engine/rigid/warm_start.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

constexpr int kNewborn = 3;  // steps in which siblings do not bounce
// Of the solves, relative to the fastest approach. Few bodies have Newton's method; in heaps a thousandth of what a
// step of gravity or the hardest impact gives is left, which moves nothing by a micrometre.
constexpr Real kTolerance = 1e-5, kHeapTolerance = 1e-3;
constexpr Real kTogether = 1e-4;   // of the pair's size, the way left to points that bounce with the first
constexpr Real kRounding = 1e-13;  // of velocities, relative to the fastest body

struct Part {
  StepWorld& world;
  Real time;
  std::vector<BodyPair> apart;  // fast pairs that do not meet
  std::vector<Contact> contacts = {};
  std::vector<ContactRow> rows = {};  // of the impact, one a contact
  std::vector<Real> approach = {};    // normal velocity before the impact, m/s
  std::vector<char> meets = {};       // the bodies touch, or meet within the part
  std::vector<Real> closing = {};     // mean normal velocity within the part, negative; of those that meet, m/s
  std::vector<Real> soonest = {};     // s, before which a point met later than the pair's first need not be; else 0
};

Real friction(const StepWorld& w, const Contact& c) {
  const Real a = w.bodies[w.index.at(c.a)].material.friction;
  return std::sqrt(a * (c.b == kGround ? w.ground.friction : w.bodies[w.index.at(c.b)].material.friction));
}

bool newborn_siblings(const StepWorld& w, const Contact& c) {
  if (c.b == kGround) return false;
  const Body &a = w.bodies[w.index.at(c.a)], &b = w.bodies[w.index.at(c.b)];
  if (a.parent != b.parent && a.parent != b.id && b.parent != a.id) return false;
  return std::min(w.state.bodies.at(a.id).age, w.state.bodies.at(b.id).age) < kNewborn;
}

Real restitution(const StepWorld& w, const Contact& c) {
  if (newborn_siblings(w, c)) return 0;
  const Real a = w.bodies[w.index.at(c.a)].material.restitution;
  return std::max(a, c.b == kGround ? w.ground.restitution : w.bodies[w.index.at(c.b)].material.restitution);
}

void make_rows(Part& p) {
  const StepWorld& w = p.world;
  const std::vector<Motion> motions = w.motions();
  const std::size_t n = p.contacts.size();
  p.rows.assign(n, {}), p.approach.resize(n), p.meets.resize(n), p.closing.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    Contact& c = p.contacts[i];
    ContactRow& r = p.rows[i];
    const bool plane = c.b == kGround;
    r.a = w.index.at(c.a), r.b = plane ? static_cast<std::uint32_t>(w.bodies.size()) : w.index.at(c.b);
    c.at_a = to_material(w.bodies[r.a], c.point);
    if (!plane) c.at_b = to_material(w.bodies[r.b], c.point);
    r.arm_a = c.point - w.bodies[r.a].pose.position;
    r.arm_b = plane ? Vec3{} : c.point - w.bodies[r.b].pose.position;
    r.axis[0] = c.normal;
    r.axis[1] = any_perpendicular(c.normal);
    r.axis[2] = cross(c.normal, r.axis[1]);
    r.friction = friction(w, c);
    p.approach[i] = normal_velocity(motions, r);
    // Both fall alike unless one is held.
    const bool a_falls = motions[r.a].inverse_mass > 0, b_falls = motions[r.b].inverse_mass > 0;
    const Real pull = dot(c.normal, w.options.gravity) * ((a_falls ? 1 : 0) - (b_falls ? 1 : 0));
    p.closing[i] = p.approach[i] + 0.5 * p.time * std::min(0.0, pull);
    p.meets[i] = c.depth >= 0 || c.depth >= p.time * p.closing[i];
  }
}

// The points of a pair that meet first bounce, and with them those that have then next to no way left (a box that lands
// flat). Others may never be met once it bounces: a plate that lands on its rim would be struck all over. Contacts are
// sorted by pair.
void find_first(Part& p, Real floor) {
  const StepWorld& w = p.world;
  const std::size_t n = p.contacts.size();
  p.soonest.assign(n, 0);
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    const Contact& pair = p.contacts[begin];
    while (end < n && p.contacts[end].a == pair.a && p.contacts[end].b == pair.b) ++end;
    Real first = p.time, fastest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (!p.meets[i]) continue;
      first = std::min(first, p.contacts[i].depth >= 0 ? 0 : p.contacts[i].depth / p.closing[i]);
      fastest = std::max(fastest, -p.closing[i]);
    }
    const Real size = w.pair_size(pair);
    for (std::size_t i = begin; i < end; ++i)
      if (p.meets[i] && first * p.closing[i] - p.contacts[i].depth > kTogether * size)
        p.soonest[i] = std::min(p.time, std::max(floor, w.options.margin * size / fastest));
  }
}

// The part ends where a point is met that did not bounce with the first.
void end_at_next(Part& p) {
  const std::vector<Motion> motions = p.world.motions();
  for (std::size_t i = 0; i < p.rows.size(); ++i) {
    if (p.soonest[i] == 0) continue;
    const Real v = normal_velocity(motions, p.rows[i]), depth = p.contacts[i].depth;
    if (depth > p.time * v) p.time = std::min(p.time, std::max(p.soonest[i], depth / v));
  }
}

// Detects contacts, and again when a touch woke sleepers (whose own contacts were skipped).
void find_contacts(Part& p, RigidStats& stats) {
  StepWorld& w = p.world;
  DetectOptions d;
  d.dt = p.time, d.margin = w.options.margin, d.max_contacts = w.options.max_contacts;
  for (;;) {
    const std::vector<std::uint8_t> resting = w.resting();
    d.resting = resting, d.apart = p.apart;
    detect_contacts(w.bodies, w.ground, d, w.cache, p.contacts, stats.contact);
    make_rows(p);
    const std::size_t now = wake_touched(w.bodies, p.contacts, p.meets, w.state);
    if (now == 0) return;
    stats.woken += now;
  }
}

FreeTime free_part(const StepWorld& w, Real time, Real floor) {
  const std::vector<std::uint8_t> resting = w.resting();
  return free_time(w.bodies, w.ground, {time, floor, w.options.margin, w.options.gravity, resting}, w.cache);
}

// Of a solve whose velocities change by about `fastest`.
Real tolerance(const IslandProblem& problem, Real fastest) {
  Real speed = 0;
  for (const Motion& m : problem.motions) speed = std::max(speed, norm(m.v));
  const Real share = problem.motions.size() > kFewMotions ? kHeapTolerance : kTolerance;
  return std::max(share * fastest + kRounding * speed, std::numeric_limits<Real>::min());
}

// Work of the rows' impulses (J) that take the velocities from those of `before` to those of `after`.
Real work(std::span<const ContactRow> rows, std::span<const Motion> before, std::span<const Motion> after) {
  Real sum = 0;
  for (const ContactRow& r : rows)
    sum += 0.5 * dot(r.total(),
                     relative_velocity(before[r.a], before[r.b], r) + relative_velocity(after[r.a], after[r.b], r));
  return sum;
}

// Newton's restitution with friction can create energy where the point slips back (Kane and Levinson 1985), and at
// several contacts at once. Without restitution the solution never does, and between the two the energy is convex, so
// the part of the way that keeps the energy is the answer: impulses stay in their cones, momenta are kept.
void limit_energy(const IslandProblem& start, IslandProblem& problem, std::vector<Motion>& after, int iterations,
                  Real accuracy) {
  const Real gained = work(problem.rows, start.motions, after);
  if (gained <= 0) return;
  IslandProblem soft = start;
  for (ContactRow& r : soft.rows) r.target = std::min(r.target, 0.0);
  std::vector<Motion> slow = soft.motions;
  solve_contacts(slow, soft.rows, iterations, accuracy);
  const auto blended = [&](Real s, std::vector<ContactRow>& rows, std::vector<Motion>& motions) {
    rows = problem.rows, motions = after;
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (int k = 0; k < 3; ++k)
        rows[i].impulse[k] = soft.rows[i].impulse[k] + s * (problem.rows[i].impulse[k] - soft.rows[i].impulse[k]);
    for (std::size_t i = 0; i < motions.size(); ++i)
      motions[i].v = slow[i].v + (after[i].v - slow[i].v) * s, motions[i].w = slow[i].w + (after[i].w - slow[i].w) * s;
    return work(rows, start.motions, motions);
  };
  std::vector<ContactRow> rows;
  std::vector<Motion> motions;
  const Real c = blended(0, rows, motions), half = blended(0.5, rows, motions);
  // work(s) = c + b s + a s^2 through its values at 0, 1/2 and 1; c < 0 < work(1).
  const Real a = 2 * (gained + c - 2 * half), b = gained - c - a;
  const Real root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
  const Real s = c < 0 ? std::clamp(-2 * c / (b + root), 0.0, 1.0) : 0;
  blended(s, rows, motions);
  problem.rows = std::move(rows), after = std::move(motions);
}

// A solve that ends above its tolerance may push too far, or rub along the motion: impulses scaled down until they do
// no work (in the worst case to none for this part) do not. What then penetrates is pushed out by displacement.
void limit_push(const IslandProblem& start, std::span<const Motion> before, IslandProblem& problem,
                std::vector<Motion>& after) {
  if (work(problem.rows, before, after) <= 0) return;
  // work(s) = a s + b s^2 for impulses times s: the velocities without them are start's.
  const Real a = work(problem.rows, before, start.motions), b = work(problem.rows, before, after) - a;
  const Real s = a < 0 ? -a / b : 0;
  for (ContactRow& r : problem.rows)
    for (Real& impulse : r.impulse) impulse *= s;
  for (std::size_t i = 0; i < after.size(); ++i)
    after[i].v = start.motions[i].v + (after[i].v - start.motions[i].v) * s,
    after[i].w = start.motions[i].w + (after[i].w - start.motions[i].w) * s;
}

// True when anything bounced.
bool solve_impact(Part& p, RigidStats& stats) {
  StepWorld& w = p.world;
  const RigidOptions& o = w.options;
  for (std::size_t i = 0; i < p.rows.size(); ++i) {
    const Contact& c = p.contacts[i];
    if (!p.meets[i] || p.soonest[i] > 0)
      p.rows[i].target = c.depth / (p.meets[i] ? p.soonest[i] : p.time);  // a gap may close but not further
    else
      p.rows[i].target = -p.approach[i] > o.restitution_speed ? -p.approach[i] * restitution(w, c) : 0;
  }
  const std::vector<Motion> motions = w.motions();
  const std::vector<Island> groups = islands(motions, p.rows);
  std::vector<SolveReport> reports(groups.size());
  parallel_for(groups.size(), 1, [&](std::size_t g) {
    IslandProblem problem = isolate(groups[g], motions, p.rows);
    const IslandProblem start = problem;
    Real fastest = norm(o.gravity) * p.time;
    for (const std::uint32_t i : groups[g].rows) fastest = std::max(fastest, -p.approach[i]);
    std::vector<Motion> after = problem.motions;
    const Real accuracy = tolerance(problem, fastest);
    reports[g] = solve_contacts(after, problem.rows, o.iterations, accuracy);
    limit_energy(start, problem, after, o.iterations, accuracy);
    put_back(groups[g], problem, p.rows);
  });
  SolveReport report;
  for (const SolveReport& r : reports) report += r;
  stats.iterations = std::max(stats.iterations, report.iterations);
  stats.residual = std::max(stats.residual, report.residual), stats.unconverged += report.unconverged;
  w.add_impulses(p.rows);
  return std::any_of(p.rows.begin(), p.rows.end(), [](const ContactRow& r) { return r.impulse[0] > 0; });
}

// Rows of the push, at the poses after half the part: `start` are those before.
std::vector<ContactRow> middle_rows(const Part& p, std::span<const Pose> start) {
  std::vector<ContactRow> rows = p.rows;
  const auto carried = [&](std::uint32_t i, const Vec3& point) {
    if (i >= start.size()) return point;
    const Pose &from = start[i], &to = p.world.bodies[i].pose;
    return rotate(to.orientation, rotate(conjugate(from.orientation), point - from.position)) + to.position;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ContactRow& r = rows[i];
    const Vec3 point = 0.5 * (carried(r.a, p.contacts[i].point) + carried(r.b, p.contacts[i].point));
    r.arm_a = point - p.world.bodies[r.a].pose.position;
    r.arm_b = r.b < start.size() ? point - p.world.bodies[r.b].pose.position : Vec3{};
    r.impulse[0] = r.impulse[1] = r.impulse[2] = 0;
  }
  return rows;
}

// Gravity and contact forces act in the middle of free motion: its first half is done, the second follows.
std::vector<ContactRow> solve_push(Part& p, std::vector<ContactRow> rows, std::vector<Real>& gaps, RigidStats& stats) {
  StepWorld& w = p.world;
  const RigidOptions& o = w.options;
  const std::vector<Motion> free = w.motions();
  std::vector<Motion> motions = free;
  std::vector<Real> before(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    before[i] = normal_velocity(motions, rows[i]);
    // The gap changes by the mean of the velocities; a gap that was closing must not be thrown back.
    const Real gap = std::max(0.0, -p.contacts[i].depth);
    rows[i].target = std::min(0.0, -before[i] - 2 * gap / p.time);
  }
  for (Motion& m : motions)
    if (m.inverse_mass > 0) m.v += o.gravity * p.time;
  warm_start(w, p.contacts, p.time, rows);
  const std::vector<Island> groups = islands(motions, rows);
  std::vector<SolveReport> reports(groups.size());
  gaps.resize(rows.size());
  parallel_for(groups.size(), 1, [&](std::size_t g) {
    IslandProblem problem = isolate(groups[g], motions, rows);
    Real fastest = norm(o.gravity) * p.time;
    for (const std::uint32_t i : groups[g].rows) fastest = std::max(fastest, -before[i]);
    const IslandProblem start = problem, unpulled = isolate(groups[g], free, rows);
    reports[g] = solve_contacts(problem.motions, problem.rows, o.iterations, tolerance(problem, fastest));
    limit_push(start, unpulled.motions, problem, problem.motions);
    put_back(groups[g], problem, rows);
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
      const std::uint32_t n = groups[g].rows[i];
      gaps[n] = -p.contacts[n].depth + 0.5 * p.time * (before[n] + normal_velocity(problem.motions, problem.rows[i]));
    }
  });
  SolveReport report;
  for (const SolveReport& r : reports) report += r;
  stats.iterations = std::max(stats.iterations, report.iterations);
  stats.residual = std::max(stats.residual, report.residual), stats.unconverged += report.unconverged;
  for (std::uint32_t i = 0; i < w.bodies.size(); ++i)
    if (w.moves(i)) w.bodies[i].velocity += o.gravity * p.time;
  w.add_impulses(rows);
  keep_warm(w, p.contacts, p.time, rows);
  return rows;
}

void move_all(StepWorld& w, Real time) {
  for (std::uint32_t i = 0; i < w.bodies.size(); ++i) {
    if (!w.moves(i)) continue;
    Body& b = w.bodies[i];
    move_freely(b, time);
    SHERD_CHECK(is_finite(b.pose.position) && is_finite(b.velocity) && is_finite(b.angular_velocity),
                "the motion of body '{}' is not finite", b.name);
  }
}

}  // namespace

Real StepWorld::pair_size(const Contact& c) const {
  const auto size = [&](BodyId id) { return cache.bounds(bodies[index.at(id)]).box.diagonal(); };
  return c.b == kGround ? size(c.a) : std::min(size(c.a), size(c.b));
}

std::vector<std::uint8_t> StepWorld::resting() const {
  std::vector<std::uint8_t> rests(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) rests[i] = state.bodies.at(bodies[i].id).asleep ? 1 : 0;
  return rests;
}

std::vector<Motion> StepWorld::motions() const {
  std::vector<Motion> motions(bodies.size() + 1);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (!moves(i)) continue;
    const Body& b = bodies[i];
    motions[i] = {b.velocity, b.angular_velocity, 1 / b.mass.mass, world_inverse_inertia(b)};
  }
  return motions;
}

void StepWorld::add_impulses(std::span<const ContactRow> rows) {
  std::vector<Vec3> push(bodies.size()), turn(bodies.size());
  for (const ContactRow& r : rows) {
    const Vec3 impulse = r.total();
    push[r.a] += impulse, turn[r.a] += cross(r.arm_a, impulse);
    if (r.b < bodies.size()) push[r.b] -= impulse, turn[r.b] -= cross(r.arm_b, impulse);
  }
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (!moves(i) || (push[i] == Vec3{} && turn[i] == Vec3{})) continue;
    Body& b = bodies[i];
    b.velocity += push[i] / b.mass.mass;
    b.angular_velocity = spin_of(b, spin_momentum(b) + turn[i]);
  }
}

PartResult step_part(StepWorld& world, Real remaining, Real floor, RigidStats& stats) {
  const FreeTime free = free_part(world, remaining, floor);
  Part p{world, free.time, free.apart};
  find_contacts(p, stats);
  find_first(p, floor);
  // Who bounces may fly fast towards others.
  if (solve_impact(p, stats)) {
    p.time = free_part(world, p.time, floor).time;
    end_at_next(p);
  }
  std::vector<Pose> start;
  for (const Body& b : world.bodies) start.push_back(b.pose);
  move_all(world, 0.5 * p.time);
  std::vector<Real> gaps;
  const std::vector<ContactRow> pushed = solve_push(p, middle_rows(p, start), gaps, stats);
  move_all(world, 0.5 * p.time);
  stats.recovery_work += recover(world, p.contacts, pushed, gaps, p.time);

  PartResult result{p.time, std::move(p.contacts), std::move(p.meets)};
  for (std::size_t i = 0; i < result.contacts.size(); ++i) {
    Contact& c = result.contacts[i];
    c.impulse = p.rows[i].total() + pushed[i].total();
    c.approach_speed = std::max(0.0, -p.approach[i]);
    stats.deepest = std::max(stats.deepest, c.depth);
    result.touches[i] = result.touches[i] || norm2(c.impulse) > 0;
  }
  return result;
}

}  // namespace sherd
