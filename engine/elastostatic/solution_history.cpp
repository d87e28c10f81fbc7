#include "engine/elastostatic/solution_history.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sherd {
namespace {

Real inner(std::span<const Real> a, std::span<const Real> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), Real{0});
}

void add_scaled(std::span<Real> y, Real s, std::span<const Real> x) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += s * x[i];
}

}  // namespace

bool SolutionHistory::guess(std::span<const Real> b, std::span<Real> x) const {
  constexpr Real kHelps = 0.1;  // share of |b| that must be covered: less saves no iteration
  std::fill(x.begin(), x.end(), Real{0});
  Real covered2 = 0;
  std::vector<Real> share;
  for (const Pair& p : pairs) share.push_back(inner(p.b, b)), covered2 += share.back() * share.back();
  if (!(covered2 > kHelps * kHelps * inner(b, b))) return false;
  for (std::size_t i = 0; i < pairs.size(); ++i) add_scaled(x, share[i], pairs[i].x);
  return true;
}

void SolutionHistory::add(std::span<const Real> b, std::span<const Real> x) {
  Pair p{{b.begin(), b.end()}, {x.begin(), x.end()}};
  const Real whole = std::sqrt(inner(b, b));
  if (!(whole > 0)) return;
  for (int pass = 0; pass < 2; ++pass)  // twice is enough (Kahan), rounding included
    for (const Pair& q : pairs) {
      const Real c = inner(q.b, p.b);
      add_scaled(p.b, -c, q.b), add_scaled(p.x, -c, q.x);
    }
  const Real left = std::sqrt(inner(p.b, p.b));
  if (!(left > kNew * whole)) return;
  for (Real& v : p.b) v /= left;
  for (Real& v : p.x) v /= left;
  if (pairs.size() == kMost) pairs.erase(pairs.begin());
  pairs.push_back(std::move(p));
}

}  // namespace sherd
