#include "kernels/fmm/far_field.h"

namespace sherd::fmm {
namespace {

// Kelvin expansions of any other ratio a / b become these and a Laplace field: outside of 1 .. 7 (Poisson's ratio 0.5
// .. -1) the equation on the surface has no unique solution, and where Laplace fields are needed anyway one table of
// translations serves all materials.
constexpr double kCommonRatio = 2;

PairSum vector_down(PairSum sum) {
  switch (sum) {
    case PairSum::kElasticGradient:
    case PairSum::kKelvinGradient:
      return PairSum::kKelvinGradient;
    case PairSum::kKelvinStress:
    case PairSum::kKelvinTraction:
      return sum;
    default:
      return PairSum::kKelvinValue;
  }
}

TranslationOptions family(const TranslationOptions& accuracy, Family f, double ratio) {
  TranslationOptions o = accuracy;
  o.family = f, o.ratio = f == Family::kKelvin ? ratio : 0;
  return o;
}

FarField kelvin_field(PairSum sum, const PairConstants<double>& c, double ratio, const TranslationOptions& accuracy) {
  FarField f;
  f.translations = family(accuracy, Family::kKelvin, ratio);
  f.up = PairSum::kKelvinValue, f.down = vector_down(sum);
  f.up_constants = {.a = ratio, .b = 1, .c = 1, .lambda = 0, .mu = 0};
  f.down_constants = {.a = ratio, .b = 1, .c = 1, .lambda = c.lambda, .mu = c.mu};
  for (std::size_t i = 0; i < 3; ++i) f.terms.push_back({i, i, c.b, false});
  return f;
}

// Three Laplace fields: the components of the displacement that Kelvin's expansion leaves.
FarField vector_laplace_field(PairSum sum, const PairConstants<double>& c, double ratio,
                              const TranslationOptions& accuracy) {
  FarField f;
  f.translations = family(accuracy, Family::kLaplace, 0);
  f.columns = 3;
  f.down = vector_down(sum);
  f.down_constants = {.a = 1, .b = 0, .c = 1, .lambda = c.lambda, .mu = c.mu};
  f.up_constants = {.a = 1, .b = 0, .c = 1, .lambda = 0, .mu = 0};
  const bool with_g = sum == PairSum::kElasticGradient, dipoles = with_g || sum == PairSum::kElasticValue;
  f.up = dipoles ? PairSum::kElasticValue : PairSum::kKelvinValue;
  for (std::size_t i = 0; i < 3; ++i) {
    f.terms.push_back({i, i, c.a - ratio * c.b, false});
    if (with_g) f.terms.push_back({i, 3 + i, c.c, false});
    const std::size_t w = with_g ? 6 : 3;
    if (dipoles) f.terms.push_back({3 + i, w + i, c.c, true}), f.terms.push_back({6 + i, w + 3 + i, 1, false});
  }
  return f;
}

FarField laplace_field(PairSum sum, const PairConstants<double>& c, const TranslationOptions& accuracy) {
  const bool dipole = sum == PairSum::kDipoleValue || sum == PairSum::kDipoleGradient;
  FarField f;
  f.translations = family(accuracy, Family::kLaplace, 0);
  f.up = dipole ? PairSum::kDipoleValue : PairSum::kLaplaceValue;
  f.down = sum == PairSum::kLaplaceValue || sum == PairSum::kDipoleValue ? PairSum::kLaplaceValue
                                                                         : PairSum::kLaplaceGradient;
  f.terms.push_back({0, 0, c.c, dipole});
  for (std::size_t i = 1; dipole && i < 4; ++i) f.terms.push_back({i, i, 1, false});
  return f;
}

}  // namespace

std::vector<FarField> far_fields(PairSum sum, const PairConstants<double>& c, const TranslationOptions& accuracy) {
  switch (sum) {
    case PairSum::kLaplaceValue:
    case PairSum::kLaplaceGradient:
    case PairSum::kDipoleValue:
    case PairSum::kDipoleGradient:
      return {laplace_field(sum, c, accuracy)};
    case PairSum::kElasticValue:
    case PairSum::kElasticGradient:
      return {kelvin_field(sum, c, kCommonRatio, accuracy), vector_laplace_field(sum, c, kCommonRatio, accuracy)};
    default:
      break;
  }
  if (c.b == 0) return {vector_laplace_field(sum, c, 0, accuracy)};
  const double ratio = c.a / c.b;
  if (ratio >= 1 && ratio <= 7) return {kelvin_field(sum, c, ratio, accuracy)};
  return {kelvin_field(sum, c, kCommonRatio, accuracy), vector_laplace_field(sum, c, kCommonRatio, accuracy)};
}

int output_power(PairSum sum, std::size_t output) {
  switch (sum) {
    case PairSum::kLaplaceGradient:
    case PairSum::kDipoleGradient:
      return output == 0 ? 1 : 2;
    case PairSum::kKelvinGradient:
    case PairSum::kKelvinStress:
    case PairSum::kKelvinTraction:
    case PairSum::kElasticGradient:
      return 2;
    default:
      return 1;
  }
}

bool is_dipole(PairSum sum, std::size_t strength) {
  switch (sum) {
    case PairSum::kDipoleValue:
    case PairSum::kDipoleGradient:
      return strength == 0;
    case PairSum::kElasticValue:
      return strength >= 3 && strength < 6;
    case PairSum::kElasticGradient:
      return strength >= 6 && strength < 9;
    default:
      return false;
  }
}

std::size_t first_normal(PairSum sum) {
  switch (sum) {
    case PairSum::kDipoleValue:
    case PairSum::kDipoleGradient:
      return 1;
    case PairSum::kElasticValue:
      return 6;
    case PairSum::kElasticGradient:
      return 9;
    default:
      return pair_shape(sum).strengths;
  }
}

}  // namespace sherd::fmm
