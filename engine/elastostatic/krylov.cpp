#include "engine/elastostatic/krylov.h"

#include <cmath>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

constexpr std::size_t kGrain = 8192;
using Vector = std::vector<Real>;

Real inner(std::span<const Real> a, std::span<const Real> b) {
  return parallel_sum<Real>(a.size(), kGrain, [&](std::size_t i) { return a[i] * b[i]; });
}
Real length(std::span<const Real> a) {
  return std::sqrt(inner(a, a));
}
void add_scaled(std::span<Real> y, Real s, std::span<const Real> x) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += s * x[i];
}
void precondition(const Preconditioner& m, std::span<const Real> r, std::span<Real> z) {
  if (m)
    m(r, z);
  else
    std::copy(r.begin(), r.end(), z.begin());
}
// r = b - A x; returns |r| / |b|.
Real residual(const LinearOperator& a, std::span<const Real> b, std::span<const Real> x, std::span<Real> r,
              Real scale) {
  a.apply(x, r);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
  return length(r) / scale;
}

// |b|; a zero right-hand side has the solution zero.
Real checked_length(const LinearOperator& a, std::span<const Real> b, std::span<Real> x) {
  SHERD_CHECK(b.size() == a.size() && x.size() == a.size(), "sizes {} {} {}", a.size(), b.size(), x.size());
  const Real scale = length(b);
  if (scale == 0) std::fill(x.begin(), x.end(), 0);
  return scale;
}

// The small least-squares problem of GMRES, kept triangular by Givens rotations.
struct Hessenberg {
  std::vector<Vector> column;
  Vector cosine, sine, rhs;

  // Adds a column (entries 0..k+1) and returns the new residual norm.
  Real add(Vector h) {
    const std::size_t k = column.size();
    for (std::size_t i = 0; i < k; ++i) {
      const Real t = cosine[i] * h[i] + sine[i] * h[i + 1];
      h[i + 1] = -sine[i] * h[i] + cosine[i] * h[i + 1];
      h[i] = t;
    }
    const Real d = std::hypot(h[k], h[k + 1]);
    cosine.push_back(d > 0 ? h[k] / d : 1), sine.push_back(d > 0 ? h[k + 1] / d : 0);
    h[k] = d;
    rhs.push_back(-sine[k] * rhs[k]);
    rhs[k] *= cosine[k];
    column.push_back(std::move(h));
    return std::abs(rhs[k + 1]);
  }
  Vector solve() const {
    const std::size_t n = column.size();
    Vector y(n);
    for (std::size_t i = n; i-- > 0;) {
      Real s = rhs[i];
      for (std::size_t j = i + 1; j < n; ++j) s -= column[j][i] * y[j];
      y[i] = column[i][i] != 0 ? s / column[i][i] : 0;
    }
    return y;
  }
};

}  // namespace

namespace {

// One cycle: minimises over x + M^-1 K and leaves the true residual b - A x in r and result.residual. What the
// preconditioner gave for each basis vector is kept when it is `flexible`, for it would give another sum for their sum.
void gmres_cycle(const LinearOperator& a, const Preconditioner& m, std::span<const Real> b, std::span<Real> x,
                 const KrylovOptions& options, Real scale, Vector& r, KrylovResult& result) {
  const std::size_t n = a.size();
  Vector z(n);
  std::vector<Vector> basis, preconditioned;
  Hessenberg h;
  h.rhs.assign(1, result.residual * scale);
  for (Real& v : r) v /= h.rhs[0];
  basis.push_back(r);
  while (result.iterations < options.max_iterations) {
    precondition(m, basis.back(), z);
    Vector w(n);
    a.apply(z, w);
    if (options.flexible) preconditioned.push_back(z);
    ++result.products, ++result.iterations;
    Vector column(basis.size() + 1);
    for (std::size_t i = 0; i < basis.size(); ++i) {
      column[i] = inner(w, basis[i]);
      add_scaled(w, -column[i], basis[i]);
    }
    const Real norm_w = column.back() = length(w);
    const Real estimate = h.add(std::move(column)) / scale;
    if (!std::isfinite(estimate)) {
      result.status = KrylovStatus::kBreakdown;
      return;
    }
    if (estimate <= options.tolerance || norm_w == 0) break;
    for (Real& v : w) v /= norm_w;
    basis.push_back(std::move(w));
  }
  const Vector y = h.solve();
  if (options.flexible) {
    for (std::size_t i = 0; i < y.size(); ++i) add_scaled(x, y[i], preconditioned[i]);
  } else {
    std::fill(r.begin(), r.end(), 0);
    for (std::size_t i = 0; i < y.size(); ++i) add_scaled(r, y[i], basis[i]);
    precondition(m, r, z);
    add_scaled(x, 1, z);
  }
  result.residual = residual(a, b, x, r, scale);
  ++result.products;
}

}  // namespace

KrylovResult gmres(const LinearOperator& a, const Preconditioner& m, std::span<const Real> b, std::span<Real> x,
                   const KrylovOptions& options) {
  KrylovResult result;
  const Real scale = checked_length(a, b, x);
  if (scale == 0) return result;
  Vector r(a.size());
  result.residual = residual(a, b, x, r, scale);
  ++result.products;
  if (!std::isfinite(result.residual)) {
    result.status = KrylovStatus::kBreakdown;
    return result;
  }
  // Rounding (of a preconditioner in single precision, say) leaves the true residual above the estimated one: as long
  // as a cycle gains, another one from its end refines the solution.
  while (result.residual > options.tolerance) {
    const Real before = result.residual;
    gmres_cycle(a, m, b, x, options, scale, r, result);
    if (result.status == KrylovStatus::kBreakdown) return result;
    const bool gained = result.residual < 0.5 * before;
    if (result.iterations >= options.max_iterations || !gained) break;
  }
  result.status =
      result.residual <= options.tolerance * 1.0000001 ? KrylovStatus::kConverged : KrylovStatus::kMaxIterations;
  return result;
}

KrylovResult bicgstab(const LinearOperator& a, const Preconditioner& m, std::span<const Real> b, std::span<Real> x,
                      const KrylovOptions& options) {
  const std::size_t n = a.size();
  KrylovResult result;
  const Real scale = checked_length(a, b, x);
  if (scale == 0) return result;
  Vector r(n), shadow(n), p(n, 0), v(n, 0), s(n), t(n), pz(n), sz(n);
  result.residual = residual(a, b, x, r, scale);
  ++result.products;
  shadow = r;
  Real rho = 1, alpha = 1, omega = 1;
  result.status = result.residual <= options.tolerance ? KrylovStatus::kConverged : KrylovStatus::kMaxIterations;
  while (result.status == KrylovStatus::kMaxIterations && result.iterations < options.max_iterations) {
    ++result.iterations;
    const Real rho_new = inner(shadow, r);
    const Real beta = (rho_new / rho) * (alpha / omega);
    rho = rho_new;
    for (std::size_t i = 0; i < n; ++i) p[i] = r[i] + beta * (p[i] - omega * v[i]);
    precondition(m, p, pz);
    a.apply(pz, v);
    alpha = rho / inner(shadow, v);
    for (std::size_t i = 0; i < n; ++i) s[i] = r[i] - alpha * v[i];
    add_scaled(x, alpha, pz);
    precondition(m, s, sz);
    a.apply(sz, t);
    result.products += 2;
    const Real tt = inner(t, t);
    omega = tt > 0 ? inner(t, s) / tt : 0;
    add_scaled(x, omega, sz);
    for (std::size_t i = 0; i < n; ++i) r[i] = s[i] - omega * t[i];
    result.residual = length(r) / scale;
    if (!std::isfinite(result.residual) || !std::isfinite(alpha))
      result.status = KrylovStatus::kBreakdown;
    else if (result.residual <= options.tolerance)
      result.status = KrylovStatus::kConverged;
    else if (omega == 0 || rho == 0)
      result.status = KrylovStatus::kBreakdown;
  }
  if (result.status != KrylovStatus::kBreakdown) result.residual = residual(a, b, x, r, scale), ++result.products;
  return result;
}

}  // namespace sherd
