// The pair sums term by term in long double, straight from their definitions: u_i,k of each term is written out as a
// full tensor, so nothing is shared with the bodies under test.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "kernels/core/random.h"
#include "kernels/fmm/pairs.h"

namespace sherd::fmm::test {

using Long = long double;

struct Tensor {
  Long value[3]{}, gradient[3][3]{};       // u_i and u_i,k
  Long value_size = 0, gradient_size = 0;  // sums of the terms' absolute values, for tolerances
};

// (a f + b e (e . f)) / l
inline void add_kelvin(const Long r[3], const Long f[3], Long a, Long b, Tensor& t) {
  const Long l = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  if (l == 0) return;
  const Long rf = r[0] * f[0] + r[1] * f[1] + r[2] * f[2];
  for (int i = 0; i < 3; ++i) {
    t.value[i] += a * f[i] / l + b * r[i] * rf / (l * l * l);
    for (int k = 0; k < 3; ++k)
      t.gradient[i][k] += -a * f[i] * r[k] / (l * l * l) + b * ((i == k ? rf : 0) + r[i] * f[k]) / (l * l * l) -
                          3 * b * r[i] * r[k] * rf / (l * l * l * l * l);
  }
  const Long size = (std::abs(a) + std::abs(b)) * (std::abs(f[0]) + std::abs(f[1]) + std::abs(f[2]));
  t.value_size += size / l, t.gradient_size += 3 * size / (l * l);
}
// c w (r . n) / l^3
inline void add_dipole(const Long r[3], const Long w[3], const Long n[3], Long c, Tensor& t) {
  const Long l = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  if (l == 0) return;
  const Long rn = r[0] * n[0] + r[1] * n[1] + r[2] * n[2];
  for (int i = 0; i < 3; ++i) {
    t.value[i] += c * w[i] * rn / (l * l * l);
    for (int k = 0; k < 3; ++k)
      t.gradient[i][k] += c * w[i] * (n[k] / (l * l * l) - 3 * rn * r[k] / (l * l * l * l * l));
  }
  const Long size = std::abs(c) * (std::abs(w[0]) + std::abs(w[1]) + std::abs(w[2])) *
                    std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  t.value_size += size / (l * l), t.gradient_size += 4 * size / (l * l * l);
}

template <class T>
struct Cloud {
  std::vector<T> x[3], y[3], normal[3], strength[kMaxStrengths];
  PairConstants<T> constants;

  Cloud(std::size_t targets, std::size_t sources, Random& random, double scale = 1)
      : constants{T(1.3), T(-0.7), T(0.4), T(0.9), T(0.6)} {
    const auto column = [&](std::size_t n, double size) {
      std::vector<T> v(n);
      for (T& a : v) a = static_cast<T>(size * random.uniform(-1, 1));
      return v;
    };
    for (int k = 0; k < 3; ++k)
      x[k] = column(targets, scale), y[k] = column(sources, scale), normal[k] = column(targets, 1);
    for (auto& s : strength) s = column(sources, 1);
  }
  PairSources<T> sources() const {
    PairSources<T> s{y[0].size(), {y[0].data(), y[1].data(), y[2].data()}, {}};
    for (std::size_t k = 0; k < kMaxStrengths; ++k) s.strength[k] = strength[k].data();
    return s;
  }
  PairTargets<T> targets() const {
    return {
        x[0].size(), {x[0].data(), x[1].data(), x[2].data()}, {normal[0].data(), normal[1].data(), normal[2].data()}};
  }
};

struct Expected {
  std::array<Long, kMaxOutputs> value{};
  std::array<Long, kMaxOutputs> size{};  // of the terms added up
};

// What one target at x receives.
template <class T>
Expected reference(PairSum sum, const Cloud<T>& cloud, std::size_t i, const T shift[3]) {
  const PairConstants<T>& c = cloud.constants;
  Tensor t;
  for (std::size_t j = 0; j < cloud.y[0].size(); ++j) {
    Long r[3], s[kMaxStrengths];
    // The target's place is rounded once, as the contract says: x + shift.
    for (int k = 0; k < 3; ++k) r[k] = Long(T(cloud.x[k][i] + shift[k])) - Long(cloud.y[k][j]);
    for (std::size_t k = 0; k < kMaxStrengths; ++k) s[k] = cloud.strength[k][j];
    const Long scalar[3] = {s[0], 0, 0};
    switch (sum) {
      case PairSum::kLaplaceValue:
      case PairSum::kLaplaceGradient:
        add_kelvin(r, scalar, c.c, 0, t);
        break;
      case PairSum::kDipoleValue:
      case PairSum::kDipoleGradient:
        add_dipole(r, scalar, s + 1, c.c, t);
        break;
      case PairSum::kElasticValue:
        add_kelvin(r, s, c.a, c.b, t), add_dipole(r, s + 3, s + 6, c.c, t);
        break;
      case PairSum::kElasticGradient:
        add_kelvin(r, s, c.a, c.b, t), add_kelvin(r, s + 3, c.c, 0, t), add_dipole(r, s + 6, s + 9, c.c, t);
        break;
      default:
        add_kelvin(r, s, c.a, c.b, t);
    }
  }
  Expected e;
  const auto put = [&](std::size_t k, Long value, Long size) { e.value[k] = value, e.size[k] = size; };
  const Long lambda = c.lambda, mu = c.mu, divergence = t.gradient[0][0] + t.gradient[1][1] + t.gradient[2][2];
  const Long stress_size = (3 * std::abs(lambda) + 2 * std::abs(mu)) * t.gradient_size;
  constexpr int kVoigt[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  const auto stress = [&](int p, int q) {
    return (p == q ? lambda * divergence : 0) + mu * (t.gradient[p][q] + t.gradient[q][p]);
  };
  switch (sum) {
    case PairSum::kLaplaceValue:
    case PairSum::kDipoleValue:
      put(0, t.value[0], t.value_size);
      break;
    case PairSum::kLaplaceGradient:
    case PairSum::kDipoleGradient:
      put(0, t.value[0], t.value_size);
      for (std::size_t k = 0; k < 3; ++k) put(1 + k, t.gradient[0][k], t.gradient_size);
      break;
    case PairSum::kKelvinValue:
    case PairSum::kElasticValue:
      for (std::size_t k = 0; k < 3; ++k) put(k, t.value[k], t.value_size);
      break;
    case PairSum::kKelvinGradient:
    case PairSum::kElasticGradient:
      for (std::size_t k = 0; k < 9; ++k) put(k, t.gradient[k / 3][k % 3], t.gradient_size);
      break;
    case PairSum::kKelvinStress:
      for (std::size_t k = 0; k < 6; ++k) put(k, stress(kVoigt[k][0], kVoigt[k][1]), stress_size);
      break;
    case PairSum::kKelvinTraction:
      for (int k = 0; k < 3; ++k) {
        Long traction = 0, size = 0;
        for (int q = 0; q < 3; ++q) {
          const Long n = cloud.normal[q][i];
          traction += stress(k, q) * n, size += stress_size * std::abs(n);
        }
        put(static_cast<std::size_t>(k), traction, size);
      }
  }
  return e;
}

inline std::vector<PairSum> all_sums() {
  std::vector<PairSum> sums;
  for (std::size_t s = 0; s < kPairSums; ++s) sums.push_back(static_cast<PairSum>(s));
  return sums;
}
inline std::vector<Instructions> available() {
  std::vector<Instructions> list;
  for (const Instructions i : {Instructions::kPortable, Instructions::kAvx2, Instructions::kAvx512})
    if (i <= best_instructions()) list.push_back(i);
  return list;
}

template <class T>
std::vector<std::vector<T>> evaluate(PairSum sum, Instructions instructions, const PairSources<T>& sources,
                                     const PairTargets<T>& targets, const PairConstants<T>& constants,
                                     const T shift[3]) {
  std::vector<std::vector<T>> out(pair_shape(sum).outputs, std::vector<T>(targets.count));
  T* columns[kMaxOutputs]{};
  for (std::size_t k = 0; k < out.size(); ++k) columns[k] = out[k].data();
  pair_function<T>(sum, instructions)(sources, targets, shift, constants, columns);
  return out;
}

}  // namespace sherd::fmm::test
