#include "engine/body/mass.h"

#include "engine/body/body.h"

namespace sherd {

MassProperties mass_properties(const SurfaceMesh& mesh, Real density) {
  const Vec3 o = bounding_box(mesh).centre();
  Real volume = 0;
  Vec3 first;   // int x dV
  Mat3 second;  // int x x^T dV
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 a = mesh.corner(t, 0) - o, b = mesh.corner(t, 1) - o, c = mesh.corner(t, 2) - o, s = a + b + c;
    const Real v = dot(a, cross(b, c)) / 6.0;
    volume += v;
    first += s * (v / 4.0);
    second += (outer(a, a) + outer(b, b) + outer(c, c) + outer(s, s)) * (v / 20.0);
  }
  MassProperties m;
  m.volume = volume;
  m.mass = density * volume;
  const Vec3 g = volume != 0 ? first / volume : Vec3{};
  m.centre = o + g;
  const Mat3 central = (second - outer(g, g) * volume) * density;
  m.inertia = Mat3::identity() * trace(central) - central;
  return m;
}

Mat3 world_inertia(const Body& b) {
  const Mat3 r = to_matrix(b.pose.orientation);
  return r * b.mass.inertia * transpose(r);
}

Mat3 world_inverse_inertia(const Body& b) {
  return b.fixed ? Mat3{} : inverse(world_inertia(b));
}

}  // namespace sherd
