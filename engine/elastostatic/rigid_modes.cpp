#include "engine/elastostatic/rigid_modes.h"

#include <cmath>

#include "engine/elastostatic/cavities.h"
#include "kernels/core/parallel.h"

namespace sherd {

RigidModes::RigidModes(const Vec3Column& points, const std::vector<Real>& weight) : weight_(weight) {
  Real total = 0;
  for (const Real w : weight_) total += w;
  for (Real& w : weight_) w /= total;
  Vec3 centre;
  for (std::size_t i = 0; i < points.size(); ++i) centre += points[i] * weight_[i];
  for (std::size_t m = 0; m < 6; ++m) {
    std::vector<Real>& mode = mode_[m];
    mode.assign(3 * points.size(), 0);
    Vec3 axis{};
    axis[static_cast<int>(m % 3)] = 1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 v = m < 3 ? axis : cross(axis, points[i] - centre);
      for (int k = 0; k < 3; ++k) mode[3 * i + static_cast<std::size_t>(k)] = v[k];
    }
    // Gram-Schmidt, twice for orthogonality to rounding
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t j = 0; j < m; ++j) {
        Real c = 0;
        for (std::size_t i = 0; i < mode.size(); ++i) c += weight_[i / 3] * mode[i] * mode_[j][i];
        for (std::size_t i = 0; i < mode.size(); ++i) mode[i] -= c * mode_[j][i];
      }
      Real n2 = 0;
      for (std::size_t i = 0; i < mode.size(); ++i) n2 += weight_[i / 3] * mode[i] * mode[i];
      for (Real& v : mode) v /= std::sqrt(n2);
    }
  }
}

std::array<Real, 6> RigidModes::coefficients(std::span<const Real> x) const {
  std::array<Real, 6> c{};
  for (std::size_t m = 0; m < 6; ++m)
    c[m] = parallel_sum<Real>(x.size(), 8192, [&](std::size_t i) { return weight_[i / 3] * mode_[m][i] * x[i]; });
  return c;
}

Real RigidModes::size(std::span<const Real> x) const {
  return std::sqrt(parallel_sum<Real>(x.size(), 8192, [&](std::size_t i) { return weight_[i / 3] * x[i] * x[i]; }));
}

std::array<Real, 6> RigidModes::coefficients_of_unit(std::size_t j) const {
  std::array<Real, 6> c = row(j);
  for (Real& v : c) v *= weight_[j / 3];
  return c;
}

std::array<Real, 6> RigidModes::row(std::size_t i) const {
  std::array<Real, 6> c{};
  for (std::size_t m = 0; m < 6; ++m) c[m] = mode_[m][i];
  return c;
}

void CompletedOperator::apply(std::span<const Real> x, std::span<Real> y) const {
  a_.apply(x, y);
  modes_.add(y, modes_.coefficients(x), kShift);
  if (cavities_) cavities_->add(x, y);
}

void CompletedOperator::apply_block(std::span<const Real> x, std::size_t count, std::span<Real> y) const {
  a_.apply_block(x, count, y);
  const std::size_t n = size();
  std::vector<Real> in(n), out(n);
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t i = 0; i < n; ++i) in[i] = x[i * count + j], out[i] = y[i * count + j];
    modes_.add(out, modes_.coefficients(in), kShift);
    if (cavities_) cavities_->add(in, out);
    for (std::size_t i = 0; i < n; ++i) y[i * count + j] = out[i];
  }
}

void RigidModes::add(std::span<Real> y, const std::array<Real, 6>& c, Real scale) const {
  for (std::size_t m = 0; m < 6; ++m)
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += scale * c[m] * mode_[m][i];
}

}  // namespace sherd
