#include "engine/stress/far_field.h"

#include <algorithm>

#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

// Closed form and seven points reach less far than in the operator, in longest edges from the centroid: gradients of
// constants err by 7e-5 with seven points at two edges and by 3e-4 with three at five (design notes, elastostatics
// section 2), a panel, which is below what the displacement brings along.
constexpr Real kNearLess = 1, kMiddleLess = 3;

}  // namespace

FarField::FarField(const Boundary& b, const std::vector<ElementField>& elements, const Elastic& material,
                   const QuadratureOptions& options)
    : boundary_(b), elements_(elements), material_(material) {
  const Real near = std::max(options.closed_form - kNearLess, 1.0),
             middle = std::max(options.gauss7 - kMiddleLess, near);
  for (std::size_t t = 0; t < elements.size(); ++t) {
    const PanelFrame& f = b.panels[t];
    near2_.push_back(near * near * f.longest2), middle2_.push_back(middle * middle * f.longest2);
    least2_ = std::min(least2_, 1e-12 * f.area);
    for (std::size_t q = 0; q < 3; ++q) {
      const TrianglePoint& p = kGauss3[q];
      const ElementField::Source& s = elements[t].far()[q];
      position_.push_back(f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c);
      density_.push_back(s.density), guenter_.push_back(s.guenter), normal_.push_back(f.normal);
      for (std::size_t i = 0; i < 9; ++i) gradient_[i].push_back(s.gradient.m[i / 3][i % 3]);
    }
  }
}

void FarField::gradients(std::span<const Vec3> x, std::span<const std::uint32_t> face, std::span<Mat3> out) const {
  double target[3 * kLanes], sum[9 * kLanes] = {};
  for (std::size_t k = 0; k < kLanes; ++k)
    for (int i = 0; i < 3; ++i) target[static_cast<std::size_t>(i) * kLanes + k] = x[k < x.size() ? k : 0][i];
  LaneElements s{{position_.x.data(), position_.y.data(), position_.z.data()},
                 {density_.x.data(), density_.y.data(), density_.z.data()},
                 {guenter_.x.data(), guenter_.y.data(), guenter_.z.data()},
                 {},
                 {normal_.x.data(), normal_.y.data(), normal_.z.data()},
                 position_.size()};
  for (std::size_t i = 0; i < 9; ++i) s.gradient[i] = gradient_[i].data();
  lane_kernels().gradient_sum(s, material_.kelvin(), 3 - 4 * material_.nu, least2_, target, sum);
  for (std::size_t k = 0; k < x.size(); ++k) {
    Mat3 g;
    for (std::size_t i = 0; i < 9; ++i) g.m[i / 3][i % 3] = sum[i * kLanes + k];
    for (std::size_t t = 0; t < elements_.size(); ++t) {
      const Real d2 = distance2(x[k], boundary_.centroid[t]);
      if (d2 > middle2_[t]) continue;
      const PanelFrame& f = boundary_.panels[t];
      const ElementField& e = elements_[t];
      const Side side = t == face[k] ? Side::kInterior : Side::kAway;
      g += (d2 > near2_[t] ? e.seven_points(f, x[k], material_) : e.closed_form(f, x[k], material_, side)) -
           e.three_points(f, x[k], material_, least2_);
    }
    out[k] = g;
  }
}

}  // namespace sherd
