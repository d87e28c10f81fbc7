#include "engine/load/earlier_loads.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/load/patch.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

// Half the forces by which two spreads of one newton differ on the faces: 0 for the same faces, 1 for others.
Real difference(const SpreadContact& a, const SpreadContact& b) {
  Real sum = 0;
  auto i = a.shares.begin(), j = b.shares.begin();
  while (i != a.shares.end() || j != b.shares.end()) {
    if (j == b.shares.end() || (i != a.shares.end() && i->first < j->first))
      sum += (i++)->second;
    else if (i == a.shares.end() || j->first < i->first)
      sum += (j++)->second;
    else
      sum += std::abs((i++)->second - (j++)->second);
  }
  return sum / 2;
}

// A contact of the load beside the one of an earlier load that it nearly is, if any.
struct Pairing {
  const SpreadContact* now;
  const SpreadContact* before;
  Real moved = 0;  // share of the earlier force that now acts elsewhere, 0 to 1
};

// A patch slides over an edge onto other faces, whose pressure is a new one however little it moved.
constexpr Real kSameFaces = 0.25, kSamePlace = 0.5;  // largest difference(); distance in radii

// Each contact of the load with the nearest one of the earlier load that it may be, each used once.
std::vector<Pairing> pair_up(std::span<const SpreadContact> contacts, std::span<const SpreadContact> earlier,
                             std::vector<const SpreadContact*>& gone) {
  std::vector<Pairing> pairs;
  std::vector<char> used(earlier.size(), 0);
  for (const SpreadContact& s : contacts) {
    const BodyContact& c = s.contact;
    std::size_t best = earlier.size();
    Real least = kSamePlace * c.patch_radius;
    for (std::size_t i = 0; i < earlier.size(); ++i)
      if (const Real d = distance(earlier[i].contact.point, c.point); !used[i] && d < least) least = d, best = i;
    const Real other_faces = best < earlier.size() ? difference(s, earlier[best]) : 1;
    if (other_faces > kSameFaces) {
      pairs.push_back({&s, nullptr});
      continue;
    }
    used[best] = 1;
    // Within a face, a pressure that moves by d or widens by d leaves a difference of about 2 d / r of its force.
    const Real before = earlier[best].contact.patch_radius, d = least + std::abs(c.patch_radius - before);
    pairs.push_back(
        {&s, &earlier[best], std::min(Real{1}, 2 * other_faces + 2 * d / std::min(c.patch_radius, before))});
  }
  for (std::size_t i = 0; i < earlier.size(); ++i)
    if (!used[i]) gone.push_back(&earlier[i]);
  return pairs;
}

// How much of the earlier load fits the load best, in the forces of their pairs.
Real share_of(const std::vector<Pairing>& pairs) {
  Real along = 0, size = 0;
  for (const Pairing& p : pairs)
    if (p.before) along += dot(p.now->contact.force, p.before->contact.force), size += norm2(p.before->contact.force);
  return size > 0 ? std::max(Real{0}, along / size) : 0;
}

void add(BoundedLoad& sum, const SpreadContact& at, Real force) {
  const Real r = at.contact.patch_radius;
  sum.force += force;
  sum.pressure = std::max(sum.pressure, force / (std::numbers::pi * r * r * at.solidity));
}

}  // namespace

std::vector<SpreadContact> spread(const SurfaceMesh& mesh, std::span<const BodyContact> contacts,
                                  const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh) {
  std::vector<SpreadContact> out(contacts.size());
  parallel_for(contacts.size(), 1, [&](std::size_t k) {
    const BodyContact& c = contacts[k];
    SpreadContact& s = out[k];
    s.contact = c, s.solidity = solidity(bvh, c.point, c.patch_radius);
    TractionPanels panels;
    append_panels(mesh, make_patch(mesh, twins, bvh, c.point, c.patch_radius, c.force), panels);
    Real whole = 0;
    for (std::size_t i = 0; i < panels.size(); ++i) {  // face by face
      const auto& [p, q, r] = panels.corners[i];
      const Real force = 0.5 * norm(cross(q - p, r - p)) * norm(panels.traction[i]);
      if (s.shares.empty() || s.shares.back().first != panels.face[i]) s.shares.push_back({panels.face[i], 0});
      s.shares.back().second += force, whole += force;
    }
    for (auto& [face, share] : s.shares) share /= whole;
  });
  return out;
}

Real tension_bound(const BoundedBody& body, std::span<const SpreadContact> contacts,
                   std::span<const SolvedLoad> earlier, const BoundedLoad& spin) {
  BoundedLoad whole = spin;
  for (const SpreadContact& c : contacts) add(whole, c, norm(c.contact.force));
  Real least = tension_bound(body, whole);
  for (const SolvedLoad& solved : earlier) {
    std::vector<const SpreadContact*> gone;
    const std::vector<Pairing> pairs = pair_up(contacts, solved.contacts, gone);
    const Real share = share_of(pairs);
    if (share == 0) continue;
    BoundedLoad rest = spin;  // about other axes, maybe: what the two pull adds up
    rest.spin = std::sqrt(spin.spin * spin.spin + share * solved.spin * solved.spin);
    for (const Pairing& p : pairs) {
      const Vec3 before = p.before ? share * p.before->contact.force : Vec3{};
      const Real moved = p.moved * norm(before);
      add(rest, *p.now, norm(p.now->contact.force - before) + moved);
      if (p.before) add(rest, *p.before, moved);
    }
    for (const SpreadContact* c : gone) add(rest, *c, share * norm(c->contact.force));
    least = std::min(least, share * solved.tension + tension_bound(body, rest));
  }
  return least;
}

}  // namespace sherd
