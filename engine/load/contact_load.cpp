#include "engine/load/contact_load.h"

#include <algorithm>

#include "engine/load/hertz.h"

namespace sherd {
Real curvature_radius(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& twins, const TriangleBvh& bvh,
                      const Vec3& point) {
  const TriangleBvh::Closest c = bvh.closest(point);
  const Vec3 n0 = normalized(mesh.area_normal2(c.face));
  const Vec3 centre0 = mesh.centroid(c.face);
  // Two rings of edge neighbours: for a sphere |n - n0| / |x - x0| = 1/R.
  std::vector<std::uint32_t> faces{c.face};
  std::size_t begin = 0;
  for (int ring = 0; ring < 3; ++ring) {
    const std::size_t end = faces.size();
    for (std::size_t i = begin; i < end; ++i)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t e = twins[3 * faces[i] + k];
        if (e != kNone && std::find(faces.begin(), faces.end(), e / 3) == faces.end()) faces.push_back(e / 3);
      }
    begin = end;
  }
  Real weighted = 0, total = 0, edge = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vec3 n2 = mesh.area_normal2(faces[i]);
    edge += std::sqrt(norm(n2));
    if (i == 0) continue;
    const Real d = distance(mesh.centroid(faces[i]), centre0), area = norm(n2);
    if (d <= 0 || area <= 0) continue;
    weighted += area * norm(normalized(n2) - n0) / d, total += area;
  }
  edge /= static_cast<Real>(faces.size());
  const Real curvature = total > 0 ? weighted / total : 0, diagonal = bounding_box(mesh).diagonal();
  return std::clamp(curvature > 0 ? 1 / curvature : diagonal, std::min(0.5 * edge, diagonal), diagonal);
}

Real shortest_duration(const ContactLoadOptions& options) {
  return options.duration > 0 ? options.duration : std::min(options.min_duration, options.time_step);
}

Real smallest_patch(Real diagonal, const ContactLoadOptions& options) {
  if (options.patch_radius > 0) return options.patch_radius;
  return std::min(options.min_patch_radius > 0 ? options.min_patch_radius : 0.02 * diagonal, 0.25 * diagonal);
}

BodyContact body_contact(const Body& body, const Body* other, const Contact& contact, Real radius, Real diagonal,
                         const ContactLoadOptions& options) {
  const Real modulus = other ? effective_modulus(body.material.young, body.material.poisson, other->material.young,
                                                 other->material.poisson)
                             : effective_modulus(body.material.young, body.material.poisson, 0, 0);
  const bool heavy = other == nullptr || other->fixed;
  const Real mass = heavy ? body.mass.mass : body.mass.mass * other->mass.mass / (body.mass.mass + other->mass.mass);
  BodyContact c;
  const bool first = contact.a == body.id;
  c.point = first ? contact.at_a : contact.at_b;
  const Vec3 impulse = first ? contact.impulse : -contact.impulse;
  // A contact that only carries load closes with at most the speed one step of free fall adds (about g dt, 1 cm/s).
  const Real resting_speed = 2 * 9.81 * options.time_step;
  Real duration = options.duration;
  if (duration <= 0)
    duration = contact.approach_speed <= resting_speed
                   ? options.time_step
                   : std::max(hertz_duration(mass, radius, modulus, contact.approach_speed), options.min_duration);
  c.duration = duration;
  c.force = rotate(conjugate(body.pose.orientation), impulse) / duration;
  c.patch_radius = options.patch_radius > 0 ? options.patch_radius
                                            : std::clamp(hertz_radius(norm(c.force), radius, modulus),
                                                         smallest_patch(diagonal, options), 0.25 * diagonal);
  return c;
}

}  // namespace sherd
