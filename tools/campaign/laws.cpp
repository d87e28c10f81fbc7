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

Real mean_angle(const CrackSheet& s, const TriangleBvh& body, const CrackField& field) {
  Vec3Column centroids;
  std::vector<Vec3> normals;  // times twice the area
  for (const Triangle& n : s.triangles) {
    const Vec3 a = s.position[n[0]], b = s.position[n[1]], c = s.position[n[2]], centroid = (a + b + c) / 3.0;
    if (!body.inside(centroid)) continue;
    centroids.push_back(centroid), normals.push_back(cross(b - a, c - a));
  }
  std::vector<PrincipalStress> stress;
  field.principal_stress(centroids, stress);
  Real sum = 0, area = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3 &n = normals[i], &e = stress[i].direction;
    sum += norm(n) * std::atan2(norm(cross(n, e)), std::abs(dot(n, e))), area += norm(n);
  }
  return area > 0 ? sum / area : 0;
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
