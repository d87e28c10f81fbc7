#include "engine/fragment/arrangement_point.h"

#include <algorithm>

#include "kernels/core/predicates.h"

namespace sherd {
namespace {

constexpr Real kEps = 0x1p-53;

Real largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

ArrangementPoint make_vertex(const Vec3& position) {
  ArrangementPoint p;
  p.position = position;
  return p;
}

ArrangementPoint make_crossing(const Vec3& u, const Vec3& v, const std::array<Vec3, 3>& plane) {
  ArrangementPoint p;
  p.exact = false, p.u = u, p.v = v, p.plane = plane;
  const FilteredValue fu = orient3d_value(plane[0], plane[1], plane[2], u);
  const FilteredValue fv = orient3d_value(plane[0], plane[1], plane[2], v);
  Real su = std::abs(fu.value), sv = std::abs(fv.value);
  // Error of the parameter su / (su + sv): sums and quotient add a few units. A nearly tangent edge gets exact values.
  Real parameter_error = (fu.error + fv.error) / (su + sv) + 4 * kEps;
  if (!(parameter_error < 32 * kEps)) {
    su = std::abs(orient3d_exact(plane[0], plane[1], plane[2], u).estimate());
    sv = std::abs(orient3d_exact(plane[0], plane[1], plane[2], v).estimate());
    parameter_error = 16 * kEps;
  }
  // From the nearer end, so that the result stays on the segment and is symmetric in u and v.
  const bool near_u = su <= sv;
  const Vec3 &from = near_u ? u : v, &to = near_u ? v : u;
  p.position = from + (to - from) * (std::min(su, sv) / (su + sv));
  p.error = 1.01 * (largest(v - u) * (parameter_error + 4 * kEps) + 4 * kEps * std::max(largest(u), largest(v)));
  return p;
}

PlanarOrientation::PlanarOrientation(const std::array<Vec3, 3>& corners, const std::vector<ArrangementPoint>& points,
                                     const std::vector<std::uint8_t>& edges)
    : points_(points), edges_(edges), exact_(points.size()) {
  const Vec3 n = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const Vec3 size{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  first_ = (axis + 1) % 3, second_ = (axis + 2) % 3;
  sign_ = orient2d(corners[0][first_], corners[0][second_], corners[1][first_], corners[1][second_], corners[2][first_],
                   corners[2][second_]);
}

// Crossing = (s_u v - s_v u) / (s_u - s_v) with s the orient3d of the end point against the plane.
const PlanarOrientation::Homogeneous& PlanarOrientation::exact(std::uint32_t i) {
  if (exact_[i]) return *exact_[i];
  const ArrangementPoint& p = points_[i];
  Homogeneous h;
  if (p.exact) {
    h = {Expansion(p.position[first_]), Expansion(p.position[second_]), Expansion(1.0)};
  } else {
    Expansion su = orient3d_exact(p.plane[0], p.plane[1], p.plane[2], p.u);
    Expansion sv = orient3d_exact(p.plane[0], p.plane[1], p.plane[2], p.v);
    if (su.sign() < 0) su = -su, sv = -sv;
    h = {su * p.v[first_] - sv * p.u[first_], su * p.v[second_] - sv * p.u[second_], su - sv};
  }
  exact_[i] = std::move(h);
  return *exact_[i];
}

int PlanarOrientation::operator()(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (!edges_.empty() && (edges_[a] & edges_[b] & edges_[c]) != 0) return 0;
  const ArrangementPoint &p = points_[a], &q = points_[b], &r = points_[c];
  const Real qx = q.position[first_] - p.position[first_], qy = q.position[second_] - p.position[second_];
  const Real rx = r.position[first_] - p.position[first_], ry = r.position[second_] - p.position[second_];
  const Real left = qx * ry, right = qy * rx, det = left - right;
  // Each difference is off by at most 2e plus rounding; products and the difference add 4 units more.
  const Real e = std::max({p.error, q.error, r.error});
  const Real bound = 2.01 * e * (std::abs(qx) + std::abs(qy) + std::abs(rx) + std::abs(ry)) + 9 * e * e +
                     4 * kEps * (std::abs(left) + std::abs(right));
  if (std::abs(det) > bound) return det > 0 ? sign_ : -sign_;
  const Homogeneous &hp = exact(a), &hq = exact(b), &hr = exact(c);
  const Expansion value =
      hp.x * (hq.y * hr.w - hr.y * hq.w) - hp.y * (hq.x * hr.w - hr.x * hq.w) + hp.w * (hq.x * hr.y - hr.x * hq.y);
  return sign_ * value.sign();
}

}  // namespace sherd
