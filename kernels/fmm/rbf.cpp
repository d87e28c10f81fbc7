#include "kernels/fmm/rbf.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <tuple>

#include "kernels/core/error.h"
#include "kernels/core/random.h"
#include "kernels/fmm/kernel_matrix.h"

namespace sherd::fmm {
namespace {

using Matrix = Eigen::MatrixXd;
using Eigen::Index;

constexpr Real kRepresenting = 0.6, kChecking = 1.5;  // radii: half of the paper's sizes
constexpr int kFewest = 8;
constexpr Real kSumError = 1.25;  // of a whole sum, in units of rbf_error()

// Equal areas along z, the golden angle around it.
std::vector<Vec3> spiral(int n, Real radius) {
  const Real angle = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Vec3> out;
  for (int i = 0; i < n; ++i) {
    const Real z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z);
    out.push_back({radius * r * std::cos(angle * i), radius * r * std::sin(angle * i), radius * z});
  }
  return out;
}

std::vector<Vec3> moved(std::vector<Vec3> points, const Vec3& by) {
  for (Vec3& p : points) p = p + by;
  return points;
}

// Densities on the representing sphere from the potential on the checking one.
Matrix inverse(const Kernel& kernel, int n) {
  return kernel_matrix(kernel, spiral(n, kChecking), spiral(n, kRepresenting)).partialPivLu().inverse();
}

int most_points(const Kernel& kernel) {
  return static_cast<int>(kMaxRbfRank / kernel.dim);
}

}  // namespace

Translations rbf_translations(const TranslationOptions& options) {
  const Kernel kernel(options);
  Translations t;
  t.dim = kernel.dim;
  t.inner = spiral(options.sphere, kRepresenting), t.outer = spiral(options.sphere, kChecking);
  t.rank = t.dim * t.inner.size();
  const auto k = static_cast<Index>(t.rank);
  t.up = inverse(kernel, options.sphere);
  t.spread = Matrix::Identity(k, k);
  for (unsigned o = 0; o < 8; ++o) {
    std::vector<Vec3> child = t.inner;
    const Vec3 centre{o & 1 ? 0.25 : -0.25, o & 2 ? 0.25 : -0.25, o & 4 ? 0.25 : -0.25};
    for (Vec3& p : child) p = p * 0.5 + centre;
    t.merge[o] = t.up * kernel_matrix(kernel, t.outer, child);
  }
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = -3; z <= 3; ++z) {
        if (std::abs(x) < 2 && std::abs(y) < 2 && std::abs(z) < 2) continue;
        t.offset[offset_index(x, y, z)] = {static_cast<std::uint16_t>(t.to_local.size()), 0};
        t.to_local.push_back(kernel_matrix(kernel, moved(t.inner, {Real(x), Real(y), Real(z)}), t.inner));
      }
  t.parity.assign(t.rank, 0);
  return t;
}

namespace {

// Every product in T, as plans make them.
template <class T>
Real measured_error(const TranslationOptions& options) {
  constexpr std::size_t kPoints = 40;
  using Work = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  const Kernel kernel(options);
  Random random(2015);
  std::vector<Vec3> points(kPoints);
  for (Vec3& p : points)
    for (int k = 0; k < 3; ++k) p[k] = random.uniform(-0.5, 0.5);
  const std::vector<Vec3> inner = spiral(options.sphere, kRepresenting);
  const Work up = inverse(kernel, options.sphere).cast<T>();
  const Work check = kernel_matrix(kernel, spiral(options.sphere, kChecking), points).cast<T>();
  const Work densities = up * check;
  Real error = 0, all = 0;
  for (int x = -2; x <= 2; x += 2)
    for (int y = -2; y <= 2; y += 2)
      for (int z = -2; z <= 2; z += 2) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3 offset{Real(x), Real(y), Real(z)};
        const Matrix exact = kernel_matrix(kernel, moved(points, offset), points);
        const Work across = kernel_matrix(kernel, moved(inner, offset), inner).cast<T>();
        const Work local = across * densities;
        const Work outer = up.transpose() * local;
        const Work values = check.transpose() * outer;
        error += (values.template cast<double>() - exact).squaredNorm(), all += exact.squaredNorm();
      }
  return std::sqrt(error / all);
}

}  // namespace

Real rbf_error(const TranslationOptions& options, bool single) {
  return single ? measured_error<float>(options) : measured_error<double>(options);
}

TranslationOptions rbf_for(TranslationOptions options, Real tolerance, bool single) {
  static std::mutex mutex;
  // Errors of the numbers of points tried so far, by family, ratio and arithmetic.
  static std::map<std::tuple<Family, Real, bool>, std::map<int, Real>> measured;
  const std::lock_guard lock(mutex);
  options.inner = options.outer = 0, options.cut = 0;
  if (options.family == Family::kLaplace) options.ratio = 0;
  const int most = most_points(Kernel(options));
  std::map<int, Real>& errors = measured[{options.family, options.ratio, single}];
  Real best = 1;
  for (int n = kFewest; n <= most; n += 1 + n / 32) {
    options.sphere = n;
    const auto found = errors.find(n);
    const Real error = found != errors.end() ? found->second : (errors[n] = rbf_error(options, single));
    best = std::min(best, error);
    if (kSumError * error <= tolerance) return options;
  }
  throw InputError(fmt::format(
      "fast multipole method: the scheme rbf-sphere reaches {:.2g} with at most {} points a sphere in {} precision, "
      "not the tolerance {:g}; use the default scheme",
      kSumError * best, most, single ? "single" : "double", tolerance));
}

std::size_t rbf_bytes(const TranslationOptions& options, std::size_t number) {
  const std::size_t rank = Kernel(options).dim * static_cast<std::size_t>(options.sphere);
  return (316 + 8 + 1) * rank * rank * (sizeof(double) + number);
}

}  // namespace sherd::fmm
