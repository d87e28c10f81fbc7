#include "engine/elastostatic/indirect.h"

#include <fmt/format.h>

#include <numbers>

#include "engine/elastostatic/dense_operator.h"
#include "kernels/core/parallel.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

// Traction at x on the plane with normal n of a unit density on a panel: block[i][j] = integral of T_ij,
// T_ij = 2 mu c / l^2 { (1 - 2 nu) (n_i e_j - n_j e_i - d_ij e.n) - 3 e_i e_j e.n }, e = (x - y)/l. Independent of mu.
struct TractionKernel {
  Real nu, scale;
  explicit TractionKernel(Real poisson) : nu(poisson), scale(1 / (16 * std::numbers::pi * (1 - poisson))) {}

  template <std::size_t N>
  Mat3 gauss(const PanelFrame& f, const Vec3& x, const Vec3& n, const std::array<TrianglePoint, N>& rule) const {
    Mat3 block;
    for (const TrianglePoint& p : rule) {
      const Vec3 r = x - (f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c);
      const Real inverse2 = 1 / norm2(r), inverse = std::sqrt(inverse2);
      const Vec3 e = r * inverse;
      const Real w = 2 * scale * p.weight * f.area * inverse2, a = (1 - 2 * nu) * w, en = dot(e, n), b = 3 * en * w;
      for (int i = 0; i < 3; ++i) {
        block[i][i] -= a * en;
        for (int j = 0; j < 3; ++j) block[i][j] += a * (n[i] * e[j] - n[j] * e[i]) - b * e[i] * e[j];
      }
    }
    return block;
  }
  // From the gradient G_ijk = c [(3 - 4 nu) d_ij A,k + M_ij,k] by Hooke's law; its divergence is 2 (1 - 2 nu) c A,j, so
  // that lambda times it stays finite for nu -> 1/2.
  Mat3 closed_form(const PanelFrame& f, const Vec3& x, const Vec3& n, Side side) const {
    PanelGradients g;
    integrate_panel_gradient(f, x, side, g);
    const Real k = 3 - 4 * nu, normal = dot(g.inverse, n);
    Mat3 block;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        Real s = 4 * nu * n[i] * g.inverse[j] + k * n[j] * g.inverse[i] + (i == j ? k * normal : 0);
        for (int m = 0; m < 3; ++m) s += n[m] * (g.dyad[m][i][j] + g.dyad[i][m][j]);
        block[i][j] = scale * s;
      }
    return block;
  }
};

// The three rows of triangle p.
void fill_rows(const Boundary& b, const TractionKernel& kernel, std::size_t p, std::span<Real> row) {
  const std::size_t size = row.size() / 3;
  const Vec3 x = b.centroid[p], n = b.panels[p].normal;
  for (std::size_t t = 0; t < b.panels.size(); ++t) {
    const PanelFrame& f = b.panels[t];
    const Real d2 = distance2(x, b.centroid[t]);
    Mat3 block;
    if (t == p)
      block = kernel.closed_form(f, x, n, Side::kOnSurface) + Mat3::identity() * 0.5;
    else if (d2 > b.middle2[t])
      block = kernel.gauss(f, x, n, kGauss3);
    else if (d2 > b.near2[t])
      block = kernel.gauss(f, x, n, kGauss7);
    else
      block = kernel.closed_form(f, x, n, Side::kAway);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) row[i * size + 3 * t + j] = block.m[i][j];
  }
}

// Means over the faces, Pa, interleaved: means, not centroid values, so that the net force is the load's.
struct FaceTractions {
  std::vector<Real> applied;     // of everything that acts on the surface
  std::vector<Real> body_force;  // sigma_p n

  explicit FaceTractions(std::size_t faces) : applied(3 * faces, 0), body_force(3 * faces, 0) {}
  static void add(std::vector<Real>& to, std::size_t face, const Vec3& t) {
    for (int k = 0; k < 3; ++k) to[3 * face + static_cast<std::size_t>(k)] += t[k];
  }
};

FaceTractions face_tractions(const Boundary& b, const Load& load, const BodyForceField& field) {
  FaceTractions out(b.panels.size());
  parallel_for(b.panels.size(), 16, [&](std::size_t t) {
    const PanelFrame& f = b.panels[t];
    if (!load.face_traction.empty()) FaceTractions::add(out.applied, t, load.face_traction[t]);
    if (!load.quadratic_traction.empty())  // only the midpoints' shape functions have a mean, a third each
      for (std::size_t k = 3; k < 6; ++k) FaceTractions::add(out.applied, t, load.quadratic_traction[6 * t + k] / 3.0);
    if (field.zero()) return;
    for (const TrianglePoint& p : kGauss3)  // exact for the stress of a force linear in x
      FaceTractions::add(out.body_force, t,
                         field.stress(f.vertex[0] * p.a + f.vertex[1] * p.b + f.vertex[2] * p.c) * f.normal * p.weight);
  });
  for (std::size_t i = 0; i < load.panels.size(); ++i) {
    const auto& c = load.panels.corners[i];
    const std::uint32_t face = load.panels.face[i];
    const Real area = 0.5 * norm(cross(c[1] - c[0], c[2] - c[0]));
    FaceTractions::add(out.applied, face, load.panels.traction[i] * (area / b.panels[face].area));
  }
  return out;
}

// Root of the area-weighted mean square of interleaved vectors.
Real mean_size(const Boundary& b, std::span<const Real> x) {
  Real sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += b.panels[i / 3].area / b.area * x[i] * x[i];
  return std::sqrt(sum);
}

std::vector<Real> areas(const Boundary& b) {
  std::vector<Real> a;
  for (const PanelFrame& f : b.panels) a.push_back(f.area);
  return a;
}

}  // namespace

IndirectBody::IndirectBody(const SurfaceMesh& mesh, const Elastic& material, const IndirectOptions& options)
    : material_(material),
      options_(options),
      boundary_(mesh, options.quadrature),
      modes_(boundary_.centroid, areas(boundary_)) {
  reason_ = too_large(mesh.triangle_count(), 3 * mesh.triangle_count(), options.double_storage, options.max_bytes);
  if (!reason_.empty()) return;
  if (options.double_storage)
    build<double>();
  else
    build<float>();
}

template <class Scalar>
void IndirectBody::build() {
  const TractionKernel kernel(material_.nu);
  auto dense = std::make_unique<DenseOperator<Scalar>>(
      boundary_.panels.size(), [&](std::size_t p, std::span<Real> rows) { fill_rows(boundary_, kernel, p, rows); });
  inverse_blocks_ = inverse_diagonal_blocks(*dense);
  operator_ = std::move(dense);
  completed_ = std::make_unique<CompletedOperator>(*operator_, modes_);
}

BodyForceField IndirectBody::body_force_field(const Load& load, const ParticularSolution& particular) const {
  return BodyForceField(boundary_, load.body_force, particular, options_.body_force, material_);
}

IndirectSolution IndirectBody::solve(const Load& load, const ParticularSolution& particular) const {
  IndirectSolution s;
  if (!ready()) {
    s.reason = reason_;
    return s;
  }
  const std::size_t n = boundary_.panels.size();
  const FaceTractions tractions = face_tractions(boundary_, load, body_force_field(load, particular));
  std::vector<Real> b = tractions.applied, x(b.size(), 0);
  for (std::size_t i = 0; i < b.size(); ++i) b[i] -= tractions.body_force[i];
  const Real scale = mean_size(boundary_, tractions.applied) + mean_size(boundary_, tractions.body_force);
  if (!std::isfinite(scale)) {
    s.reason = "the load is not finite";
    return s;
  }
  Real rigid2 = 0;
  for (const Real c : modes_.coefficients(b)) rigid2 += c * c;
  s.incompatibility = scale > 0 ? std::sqrt(rigid2) / scale : 0;
  const auto jacobi = [&](std::span<const Real> r, std::span<Real> z) { apply_blocks(inverse_blocks_, r, z); };
  s.krylov = options_.method == KrylovMethod::kGmres ? gmres(*completed_, jacobi, b, x, options_.krylov)
                                                     : bicgstab(*completed_, jacobi, b, x, options_.krylov);
  s.density.resize(n);
  bool finite = true;
  for (std::size_t i = 0; i < n; ++i) {
    s.density.set(i, {x[3 * i], x[3 * i + 1], x[3 * i + 2]});
    finite = finite && is_finite(s.density[i]);
  }
  // BiCGSTAB updates its residual by recursion, which parts from the true one when it struggles.
  s.ok = finite && s.krylov.status == KrylovStatus::kConverged && s.krylov.residual <= 10 * options_.krylov.tolerance;
  if (!s.ok)
    s.reason = fmt::format("the solver stopped after {} iterations at a relative residual of {:.2e} (asked for {:.1e})",
                           s.krylov.iterations, s.krylov.residual, options_.krylov.tolerance);
  return s;
}

}  // namespace sherd
