#include <cmath>

#include "engine/mesh/certificate.h"
#include "tools/campaign/crack.h"

namespace sherd::campaign {
namespace {

// S3, S5: what the outcome claims about the border.
std::string check_border(const CrackSheet& s, const TriangleBvh& body, GrowthOutcome outcome) {
  std::vector<TriangleBvh::Hit> hits;
  bool complete = true, arrested = false;
  for (const auto& loop : border_loops(s))
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      if (s.state[a] == NodeState::kInterior) return "a border node is interior";
      if (s.state[a] == NodeState::kExited && body.inside(s.position[a])) return "an exited node lies inside";
      if (s.state[a] == NodeState::kArrested) arrested = true;
      body.all_hits(s.position[a], s.position[b] - s.position[a], 0, 1, hits);
      complete &= s.state[a] == NodeState::kExited && s.state[b] == NodeState::kExited && hits.empty();
    }
  if (complete != (outcome == GrowthOutcome::kComplete)) return "completeness is not what the border shows";
  if (outcome == GrowthOutcome::kArrested && !arrested) return "arrested without an arrested node";
  return {};
}

}  // namespace

Real sheet_area(const CrackSheet& s) {
  Real sum = 0;
  for (const Triangle& n : s.triangles)
    sum += 0.5 * norm(cross(s.position[n[1]] - s.position[n[0]], s.position[n[2]] - s.position[n[0]]));
  return sum;
}

std::string check_sheet_laws(const GrowthResult& r, const TriangleBvh& body) {
  if (r.outcome != GrowthOutcome::kComplete && r.outcome != GrowthOutcome::kArrested)
    return r.reason.empty() ? "failed without a reason" : "";
  if (std::string bad = check_sheet(r.sheet); !bad.empty()) return bad;
  return check_border(r.sheet, body, r.outcome);
}

Real balance_of(const CutBody& body, const CutResult& c) {
  Real sum = c.removed_volume + c.dust_volume;
  for (const SurfaceMesh& f : c.fragments) sum += signed_volume(f);
  return std::abs(body.volume() - sum) / body.volume();
}

std::string check_cut_laws(const CutBody& body, const CutResult& c) {
  constexpr Real kBalance = 1e-9;  // V1
  if (c.fragments.empty()) return "no fragment is left";
  for (const SurfaceMesh& f : c.fragments) {
    const MeshCertificate certificate = certify(f);
    if (!certificate.ok()) return "a fragment has no certificate: " + certificate.first_defect;
  }
  return balance_of(body, c) < kBalance ? "" : "volumes do not balance";
}

}  // namespace sherd::campaign
