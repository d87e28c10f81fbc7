#include "kernels/core/expansion.h"

#include <algorithm>

namespace sherd {
namespace {

struct Pair {
  double high, low;
};
// high + low = a + b exactly, high = fl(a + b) (Knuth).
Pair two_sum(double a, double b) {
  const double s = a + b, bv = s - a, av = s - bv;
  return {s, (a - av) + (b - bv)};
}
// The same when |a| >= |b| (Dekker).
Pair fast_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}
Pair two_product(double a, double b) {
  const double p = a * b;
  return {p, std::fma(a, b, -p)};
}

}  // namespace

Expansion Expansion::difference(double a, double b) {
  const Pair d = two_sum(a, -b);
  Expansion e;
  if (d.low != 0) e.terms_.push_back(d.low);
  if (d.high != 0) e.terms_.push_back(d.high);
  return e;
}

double Expansion::estimate() const {
  double sum = 0;
  for (double t : terms_) sum += t;
  return sum;
}

Expansion Expansion::operator-() const {
  Expansion r = *this;
  for (double& t : r.terms_) t = -t;
  return r;
}

// Shewchuk's COMPRESS: afterwards the terms are non-adjacent and as few as the value needs.
void Expansion::compress() {
  const std::size_t n = terms_.size();
  if (n < 2) return;
  double q = terms_[n - 1];
  std::size_t bottom = n;
  for (std::size_t i = n - 1; i-- > 0;) {
    const Pair s = fast_two_sum(q, terms_[i]);
    q = s.high;
    if (s.low != 0) terms_[--bottom] = q, q = s.low;
  }
  std::size_t top = 0;
  for (std::size_t i = bottom; i < n; ++i) {
    const Pair s = fast_two_sum(terms_[i], q);
    q = s.high;
    if (s.low != 0) terms_[top++] = s.low;
  }
  if (q != 0) terms_[top++] = q;
  terms_.resize(top);
}

// LINEAR-EXPANSION-SUM: needs non-overlapping operands only, unlike the fast version.
Expansion operator+(const Expansion& a, const Expansion& b) {
  if (a.terms_.empty()) return b;
  if (b.terms_.empty()) return a;
  std::vector<double> g(a.terms_.size() + b.terms_.size());
  std::merge(a.terms_.begin(), a.terms_.end(), b.terms_.begin(), b.terms_.end(), g.begin(),
             [](double x, double y) { return std::abs(x) < std::abs(y); });
  Expansion r;
  r.terms_.reserve(g.size());
  Pair q = two_sum(g[1], g[0]);
  for (std::size_t i = 2; i < g.size(); ++i) {
    const Pair s = two_sum(g[i], q.low);
    if (s.low != 0) r.terms_.push_back(s.low);
    q = two_sum(q.high, s.high);
  }
  if (q.low != 0) r.terms_.push_back(q.low);
  if (q.high != 0) r.terms_.push_back(q.high);
  r.compress();
  return r;
}

// SCALE-EXPANSION
Expansion operator*(const Expansion& a, double b) {
  Expansion r;
  if (a.terms_.empty() || b == 0) return r;
  r.terms_.reserve(2 * a.terms_.size());
  Pair q = two_product(a.terms_[0], b);
  if (q.low != 0) r.terms_.push_back(q.low);
  for (std::size_t i = 1; i < a.terms_.size(); ++i) {
    const Pair t = two_product(a.terms_[i], b);
    const Pair s = two_sum(q.high, t.low);
    if (s.low != 0) r.terms_.push_back(s.low);
    q = fast_two_sum(t.high, s.high);
    if (q.low != 0) r.terms_.push_back(q.low);
  }
  if (q.high != 0) r.terms_.push_back(q.high);
  r.compress();
  return r;
}

Expansion operator*(const Expansion& a, const Expansion& b) {
  const Expansion &longer = a.size() >= b.size() ? a : b, &shorter = a.size() >= b.size() ? b : a;
  Expansion r;
  for (double t : shorter.terms_) r = r + longer * t;
  return r;
}

}  // namespace sherd
