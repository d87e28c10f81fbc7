#include <cmath>

#include "engine/mesh/certificate.h"
#include "tools/campaign/crack.h"

namespace sherd::campaign {

Real sheet_area(const CrackSheet& s) {
  Real sum = 0;
  for (const Triangle& n : s.triangles)
    sum += 0.5 * norm(cross(s.position[n[1]] - s.position[n[0]], s.position[n[2]] - s.position[n[0]]));
  return sum;
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
