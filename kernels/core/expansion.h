// Exact arithmetic on sums of doubles (Shewchuk, Adaptive precision floating-point arithmetic, 1997): an expansion is a
// sum of non-overlapping doubles, smallest first, so its sign is the sign of its last component. Addition, subtraction
// and multiplication are exact as long as nothing overflows or underflows. For the rare cases a floating-point filter
// leaves.
#pragma once
#include <cmath>
#include <vector>

namespace sherd {

class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(double a) {
    if (a != 0) terms_.push_back(a);
  }
  // a - b
  static Expansion difference(double a, double b);

  int sign() const { return terms_.empty() ? 0 : (terms_.back() > 0 ? 1 : -1); }
  // Nearest double within two units in the last place (terms are compressed, hence non-adjacent).
  double estimate() const;
  std::size_t size() const { return terms_.size(); }

  Expansion operator-() const;
  friend Expansion operator+(const Expansion& a, const Expansion& b);
  friend Expansion operator-(const Expansion& a, const Expansion& b) { return a + (-b); }
  friend Expansion operator*(const Expansion& a, double b);
  friend Expansion operator*(const Expansion& a, const Expansion& b);

 private:
  void compress();

  std::vector<double> terms_;  // no zeros, growing magnitude; empty is zero
};

}  // namespace sherd
