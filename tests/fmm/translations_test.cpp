// Laws of the expansions of a single box, for every setting that a tolerance asks for.
#include "kernels/fmm/translations.h"

#include <gtest/gtest.h>

#include "kernels/fmm/accuracy.h"
#include "tests/fmm/tree_support.h"

namespace sherd::fmm {
namespace {

using Vector = Eigen::VectorXd;
using Eigen::Index;

struct Setting {
  Family family;
  double tolerance;
};
std::vector<Setting> settings() {
  std::vector<Setting> out{{Family::kKelvin, 1e-3}, {Family::kKelvin, 1e-4}};
  for (const double t : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) out.push_back({Family::kLaplace, t});
  return out;
}
TranslationOptions options(const Setting& s) {
  TranslationOptions o = accuracy_for(s.tolerance);
  o.family = s.family, o.ratio = s.family == Family::kKelvin ? 2 : 0;
  return o;
}

// Straight from the definition: (ratio f + e (e . f)) / l, or f / l.
Vector potential(const TranslationOptions& o, const std::vector<Vec3>& targets, const std::vector<Vec3>& sources,
                 const Vector& strengths) {
  const Index d = o.family == Family::kKelvin ? 3 : 1;
  Vector out = Vector::Zero(d * static_cast<Index>(targets.size()));
  for (std::size_t p = 0; p < targets.size(); ++p)
    for (std::size_t q = 0; q < sources.size(); ++q) {
      const Vec3 r = targets[p] - sources[q];
      const double l = norm(r);
      const auto at = d * static_cast<Index>(p), from = d * static_cast<Index>(q);
      if (d == 1) {
        out[at] += strengths[from] / l;
        continue;
      }
      const Vec3 f{strengths[from], strengths[from + 1], strengths[from + 2]};
      const Vec3 u = f * (o.ratio / l) + r * (dot(r, f) / (l * l * l));
      out[at] += u.x, out[at + 1] += u.y, out[at + 2] += u.z;
    }
  return out;
}

std::vector<Vec3> cube(std::size_t n, std::uint64_t seed, double side, const Vec3& centre) {
  Random random(seed);
  std::vector<Vec3> out(n);
  for (Vec3& p : out)
    p = centre + Vec3{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)} * side;
  return out;
}
std::vector<Vec3> moved(std::vector<Vec3> points, const Vec3& shift, double scale) {
  for (Vec3& p : points) p = p * scale + shift;
  return points;
}
Vector random_vector(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  Vector v(static_cast<Index>(n));
  for (double& x : v) x = random.uniform(-1, 1);
  return v;
}

double relative(const Vector& got, const Vector& right) {
  return (got - right).norm() / right.norm();
}

Vector flipped(const Translations& t, unsigned axes, Vector v) {
  for (std::size_t k = 0; k < t.rank; ++k)
    if (__builtin_popcount(axes & t.parity[k]) % 2) v[static_cast<Index>(k)] *= -1;
  return v;
}

TEST(Translations, ReflectedSourcesFlipTheOddCoefficients) {
  for (const Family f : {Family::kLaplace, Family::kKelvin}) {
    const TranslationOptions o = options({f, 1e-3});
    const auto t = translations(o);
    const auto sources = cube(30, 1, 1, {});
    const Vector strengths = random_vector(t->dim * 30, 2);
    const Vector multipole = t->up * potential(o, t->outer, sources, strengths);
    for (unsigned axes = 0; axes < 8; ++axes) {
      auto mirror = sources;
      Vector g = strengths;
      for (std::size_t i = 0; i < mirror.size(); ++i)
        for (int k = 0; k < 3; ++k)
          if ((axes >> k) & 1) {
            mirror[i][k] *= -1;
            if (t->dim == 3) g[static_cast<Index>(3 * i) + k] *= -1;
          }
      const Vector other = t->up * potential(o, t->outer, mirror, g);
      EXPECT_LT(relative(other, flipped(*t, axes, multipole)), 1e-11);
    }
  }
}

// Sources in an eighth of one box, targets in an eighth of another: leaf to multipole, merged, to a local expansion,
// split, to the targets.
double chain_error(const TranslationOptions& o, unsigned from, unsigned to, const std::array<int, 3>& offset) {
  const auto t = translations(o);
  const auto octant = [](unsigned k) { return Vec3{k & 1 ? 0.25 : -0.25, k & 2 ? 0.25 : -0.25, k & 4 ? 0.25 : -0.25}; };
  const Vec3 shift{Real(offset[0]), Real(offset[1]), Real(offset[2])};
  const auto sources = cube(40, 3, 0.5, octant(from)), targets = cube(60, 4, 0.5, octant(to) + shift);
  const Vector strengths = random_vector(t->dim * 40, 5);
  // In units of the child: lengths doubled, so potentials halved.
  const auto child_sources = moved(sources, octant(from) * -2.0, 2);
  const Vector child = t->up * potential(o, t->outer, child_sources, strengths);
  const Vector multipole = t->merge[from] * child;
  const auto& entry = t->offset[static_cast<std::size_t>((offset[0] + 3) * 49 + (offset[1] + 3) * 7 + offset[2] + 3)];
  const Vector local = flipped(*t, entry.flips, t->to_local[entry.matrix] * flipped(*t, entry.flips, multipole));
  const Vector child_local = t->merge[to].transpose() * local;
  const Vector density = t->up.transpose() * child_local;
  const auto child_targets = moved(targets, (octant(to) + shift) * -2.0, 2);
  // The local is the potential in the parent's units, the density acts in the child's, where the same one gives half.
  const Vector got = potential(o, child_targets, t->outer, density);
  return relative(got, potential(o, targets, sources, strengths));
}

TEST(Translations, TheWholeChainIsTheKernelToTheTolerance) {
  for (const Setting& s : settings()) {
    double worst = 0;
    // Nearest pairs, faces and corners facing each other, and the farthest.
    for (const auto& [from, to, offset] : {std::tuple{1u, 0u, std::array{2, 0, 0}},
                                           {0u, 7u, std::array{-2, -2, -2}},
                                           {2u, 5u, std::array{1, -2, 1}},
                                           {6u, 1u, std::array{0, 1, 3}},
                                           {0u, 7u, std::array{3, 3, 3}},
                                           {4u, 3u, std::array{-3, 2, 0}}})
      worst = std::max(worst, chain_error(options(s), from, to, offset));
    // A single pair of near boxes, its strengths about zero, exceeds the error of a whole sum, of which most is exact
    // or farther: 10 to 60 times the tolerance, the more the more digits are asked for.
    EXPECT_LT(worst, 80 * s.tolerance) << s.tolerance << (s.family == Family::kKelvin ? " kelvin" : " laplace");
  }
}

TEST(Translations, AFarFieldHasFewDegreesOfFreedom) {
  // The paper's Figure 6 in space: 1e5 particles of random mass, crowded in places, seen from beyond the neighbouring
  // boxes; and the forces of a body.
  Random random(6);
  std::vector<Vec3> sources;
  const auto centres = cube(12, 7, 0.8, {});
  while (sources.size() < 100000) {
    const Vec3 p = centres[random.next() % 12] +
                   Vec3{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.3, 0.3)};
    if (std::abs(p.x) < 0.5 && std::abs(p.y) < 0.5 && std::abs(p.z) < 0.5) sources.push_back(p);
  }
  std::vector<Vec3> targets;
  for (int i = 0; i < 120; ++i) {
    Vec3 p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    p[i % 3] = i % 2 ? 1 : -1;
    targets.push_back(p * (i < 60 ? 1.5 : random.uniform(1.5, 4.5)));
  }
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const TranslationOptions o = options({Family::kLaplace, tolerance});
    const auto t = translations(o);
    Vector masses = random_vector(sources.size(), 8);
    for (double& m : masses) m = std::abs(m);
    const Vector multipole = t->up * potential(o, t->outer, sources, masses);
    const Vector got = potential(o, targets, t->inner, t->spread * multipole);
    EXPECT_LT(relative(got, potential(o, targets, sources, masses)), tolerance);
    // Spherical harmonics of order p about the centre err by (0.87 / 1.5)^(p + 1) and have (p + 1)^2 coefficients.
    const double orders = std::ceil(std::log(tolerance) / std::log(std::sqrt(0.75) / 1.5));
    EXPECT_LT(static_cast<double>(t->rank), 0.5 * orders * orders) << tolerance;
  }
}

}  // namespace
}  // namespace sherd::fmm
