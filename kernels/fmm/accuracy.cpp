#include "kernels/fmm/accuracy.h"

#include <fmt/format.h>

#include <array>

#include "kernels/core/error.h"

namespace sherd::fmm {
namespace {

struct Level {
  Real tolerance;
  int inner, outer;
  Real cut;
};
// Measured (sherd-bench fmm): the coarsest settings with which the sums of values of the Laplace, Kelvin and elastic
// families stay 10 % or more below the tolerance on spheres and ellipsoids and throughout a cube, where the errors are
// twice those on surfaces.
constexpr std::array<Level, 8> kLevels{{{1e-2, 4, 5, 2.6e-3},
                                        {1e-3, 4, 6, 2.8e-4},
                                        {1e-4, 5, 7, 2.6e-5},
                                        {1e-5, 6, 8, 2.7e-6},
                                        {1e-6, 8, 9, 2.4e-7},
                                        {1e-7, 9, 11, 1.9e-8},
                                        {1e-8, 11, 13, 2.2e-9},
                                        {1e-9, 11, 13, 2.4e-10}}};

// Million pairs a second with AVX-512 in single precision (sherd-bench pairs); double runs at 0.43 of it.
double rate(PairSum sum) {
  constexpr std::array<double, kPairSums> kRates{11200, 5700, 7500, 3700, 4400, 2400, 2600, 2600, 3100, 1360};
  return 1e6 * kRates[static_cast<std::size_t>(sum)];
}
constexpr double kDoublePairs = 0.43;
constexpr double kProductRate = 9e10;  // operations a second of the k x k products, single; double: half

}  // namespace

TranslationOptions accuracy_for(Real tolerance) {
  if (!(tolerance >= 1e-9 && tolerance <= 1e-2))
    throw InputError(fmt::format("fast multipole method: tolerance {:g} is outside 1e-9 .. 1e-2", tolerance));
  std::size_t i = 0;
  while (kLevels[i].tolerance > tolerance * 1.0000001) ++i;
  TranslationOptions o;
  o.inner = kLevels[i].inner, o.outer = kLevels[i].outer;
  o.cut = kLevels[i].cut * tolerance / kLevels[i].tolerance;
  return o;
}

CostModel cost_model(PairSum sum, const std::vector<FarField>& fields, bool single_far, bool single_near) {
  CostModel m;
  m.pair = 1 / (rate(sum) * (single_near ? 1 : kDoublePairs));
  for (const FarField& f : fields) {
    const auto t = translations(f.translations);
    const double k = static_cast<double>(t->rank), columns = static_cast<double>(f.columns);
    const double operation = 1 / (kProductRate * (single_far ? 1 : 0.5));
    m.far += columns * (2 * k * k * operation + 6 * k * (single_far ? 0.1e-9 : 0.2e-9));
    m.box += columns * 4 * k * (k + static_cast<double>(t->dim * t->outer.size())) * operation + 1e-6;
    m.surface += (1 / rate(f.up) + 1 / rate(f.down)) / (single_far ? 1 : kDoublePairs) / 2;
    m.inner = static_cast<double>(t->inner.size()), m.outer = static_cast<double>(t->outer.size());
  }
  return m;
}

double cost(const CostModel& m, const Tree& tree, const ListCounts& c) {
  const double points = static_cast<double>(tree.source_order.size() + tree.target_order.size());
  return c.direct_pairs * m.pair + c.far_pairs * m.far +
         ((c.multipole_points + c.local_points) * m.inner + points * m.outer) * m.surface +
         static_cast<double>(tree.box_count()) * m.box;
}

}  // namespace sherd::fmm
