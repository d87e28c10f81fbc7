#include "engine/elastostatic/solver.h"

#include <fmt/format.h>

#include <numeric>

#include "engine/elastostatic/direct_assembly.h"
#include "engine/mesh/thickness.h"
#include "kernels/core/trace.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

// Edge length over wall thickness of each face.
std::vector<Real> edge_over_wall(const SurfaceMesh& mesh) {
  const std::vector<Real> thickness = wall_thickness(mesh).face;
  std::vector<Real> out = local_edge_length(mesh);
  for (std::size_t t = 0; t < out.size(); ++t) out[t] /= thickness[t];
  return out;
}

// Petrov-Galerkin on walls that the mesh does not resolve for collocation.
std::vector<VertexTest> vertex_tests(const SurfaceMesh& mesh, const std::vector<Real>& ratio, const ElasticOptions& o) {
  const bool linear = o.reconstruction.element == Element::kLinear;
  std::vector<VertexTest> out(mesh.vertex_count(),
                              o.testing == TestingRule::kGalerkin ? VertexTest::kGalerkin : VertexTest::kCollocation);
  if (o.testing != TestingRule::kAuto || linear) return out;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (ratio[t] <= o.thin_ratio) continue;
    for (const std::uint32_t v : mesh.triangles[t]) out[v] = VertexTest::kGalerkin;
  }
  return out;
}

constexpr Real kSingleReaches = 1e-5;  // single precision: as a far field's tolerance and as a residual

// Without a coarse space, the fast operator's bodies converge in this many iterations or are thin.
constexpr int kPlainIterations = 120;
constexpr std::size_t kFastCoarseDimension = 120;

// Walls so thin that the coarse space would need hundreds of iterations: over half a percent of the surface.
bool has_slender_walls(const SurfaceMesh& mesh, const std::vector<Real>& ratio) {
  Real slender = 0, area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Real a = norm(mesh.area_normal2(t));
    area += a;
    if (ratio[t] > 2.5) slender += a;
  }
  return slender > 0.005 * area;
}

}  // namespace

ElasticBody::ElasticBody(const SurfaceMesh& mesh, const Elastic& material, const ElasticOptions& options)
    : material_(material),
      options_(options),
      boundary_(mesh, options.quadrature),
      edge_over_wall_(edge_over_wall(boundary_.mesh)),
      reconstruction_(boundary_.mesh, material.nu, options.reconstruction),
      testing_(boundary_, reconstruction_, vertex_tests(boundary_.mesh, edge_over_wall_, options)),
      modes_(boundary_.mesh.vertices, boundary_.vertex_area),
      cavities_(boundary_, reconstruction_, modes_) {
  slender_ = has_slender_walls(boundary_.mesh, edge_over_wall_);
  const std::size_t n = 3 * mesh.vertex_count();
  const bool dense = options.kind == OperatorKind::kDense ||
                     (options.kind == OperatorKind::kAuto &&
                      n <= (is_bulky(boundary_) ? options.dense_bulky_unknowns : options.dense_unknowns));
  reason_ = dense ? too_large(mesh.triangle_count(), n, options.double_storage, options.max_bytes)
                  : FastOperator::too_large(boundary_, testing_, options.max_bytes);
  if (!reason_.empty()) return;
  if (!dense)
    build_fast();
  else if (options.double_storage)
    build_dense<double>();
  else
    build_dense<float>();
  precondition();
}

template <class Scalar>
void ElasticBody::build_dense() {
  const TraceScope scope("assemble");
  auto dense = std::make_unique<DenseOperator<Scalar>>(boundary_.mesh.vertex_count());
  assemble_direct(boundary_, reconstruction_, material_.nu, testing_, *dense);
  make_factors_ = [this, &a = *dense] { return std::make_unique<FactoredInverse>(a, modes_, cavities_); };
  operator_bytes_ = dense->size() * dense->size() * sizeof(Scalar);
  operator_ = std::move(dense);
}

void ElasticBody::build_fast() {
  const TraceScope scope("assemble");
  FastOptions o = options_.fast;
  if (o.tolerance <= 0) o.tolerance = far_tolerance(boundary_);
  // Rounding must stay below the residual asked for, or the iteration stalls: single precision has 1e-6 of the
  // displacement, which slender bodies make large against the right-hand side.
  if (o.tolerance < kSingleReaches || options_.krylov.tolerance < kSingleReaches)
    o.arithmetic = fmm::Arithmetic::kDouble;
  auto fast = std::make_unique<FastOperator>(boundary_, reconstruction_, material_.nu, testing_, o);
  operator_bytes_ = fast->bytes();
  operator_ = std::move(fast);
}

// A coarse space costs products with the operator: the fast one first tries without, unless walls are slender.
void ElasticBody::precondition() {
  const TraceScope scope("precondition");
  inverse_blocks_ = inverse_diagonal_blocks(*operator_);
  completed_ = std::make_unique<CompletedOperator>(*operator_, modes_, &cavities_);
  const std::size_t n = operator_->size();
  const bool factors =
      make_factors_ &&
      (options_.preconditioning == Preconditioning::kFactored ||
       (options_.preconditioning == Preconditioning::kAuto && (n <= 1500 || (n <= 12000 && slender_))));
  if (factors && factor()) return;
  if (make_factors_ || slender_ || options_.coarse_space || options_.preconditioning == Preconditioning::kDeflation)
    deflate();
}

void ElasticBody::deflate() const {
  DeflationOptions o = options_.deflation;
  if (!make_factors_) o.max_dimension = std::min<std::size_t>(o.max_dimension, kFastCoarseDimension);
  deflation_ = std::make_unique<Deflation>(*completed_, boundary_, inverse_blocks_, o);
}

bool ElasticBody::needs_coarse_space() const {
  const std::lock_guard lock(factoring_);
  return deflation_ != nullptr;
}

bool ElasticBody::factor() const {
  const std::lock_guard lock(factoring_);
  if (make_factors_ && !factored_ && FactoredInverse::bytes(operator_->size()) <= options_.max_bytes)
    factored_ = make_factors_();
  return factored_ && factored_->ok();
}

KrylovResult ElasticBody::iterate(std::span<const Real> b, std::span<Real> x, bool& factored) const {
  factored = false;
  KrylovResult total;
  const auto attempt = [&](const Preconditioner& m, const KrylovOptions& options) {
    for (const Real v : x)
      if (!std::isfinite(v)) {
        std::fill(x.begin(), x.end(), 0);
        break;
      }
    const int iterations = total.iterations, products = total.products;
    total = gmres(*completed_, m, b, x, options);
    total.iterations += iterations, total.products += products;
    return total.status == KrylovStatus::kConverged;
  };
  const auto ready = [&](const auto& preconditioner) {
    const std::lock_guard lock(factoring_);
    return preconditioner != nullptr;
  };
  if (!ready(factored_) && !ready(deflation_)) {
    KrylovOptions few = options_.krylov;
    few.max_iterations = std::min(few.max_iterations, kPlainIterations);
    if (attempt([&](auto r, auto z) { apply_blocks(inverse_blocks_, r, z); }, few) ||
        few.max_iterations == options_.krylov.max_iterations)
      return total;
    const std::lock_guard lock(factoring_);
    if (!deflation_) deflate();
  }
  if (ready(deflation_) && (attempt([&](auto r, auto z) { deflation_->apply(r, z); }, options_.krylov) ||
                            options_.preconditioning == Preconditioning::kDeflation || !factor()))
    return total;
  factored = true;
  KrylovOptions flexible = options_.krylov;
  flexible.flexible = true;
  attempt([&](auto r, auto z) { factored_->apply(r, z); }, flexible);
  return total;
}

// Mean stress = integral of x t^T over the boundary / volume, for tractions in balance (divergence theorem).
ParticularSolution ElasticBody::particular(const Load& load) const {
  const ParticularSolution force(load.body_force, material_);
  const Vec3 centre = bounding_box(boundary_.mesh).centre();
  Mat3 moment;
  for (std::size_t t = 0; t < boundary_.panels.size(); ++t) {
    const PanelFrame& f = boundary_.panels[t];
    const auto q = traction_polynomial(boundary_, load, force, t);
    for (const TrianglePoint& g : kGauss7) {
      const auto m = cubic::monomials(g.b, g.c);
      Vec3 traction;
      for (std::size_t k = 0; k < q.size(); ++k) traction += q[k] * m[k];
      moment +=
          outer(f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c - centre, traction) * (g.weight * f.area);
    }
  }
  for (std::size_t i = 0; i < load.panels.size(); ++i) {
    const auto& c = load.panels.corners[i];
    const PanelFrame f = make_panel(c[0], c[1], c[2]);
    moment += outer(f.centroid() - centre, load.panels.traction[i] * f.area);
  }
  return {load.body_force, material_, symmetric_part(moment) * (1 / signed_volume(boundary_.mesh))};
}

// Of the whole displacement without its rigid motion, rms over the surface.
Real ElasticBody::strained_size(std::span<const Real> homogeneous, const ParticularSolution& particular) const {
  std::vector<Real> u(homogeneous.begin(), homogeneous.end());
  for (std::size_t i = 0; i < boundary_.mesh.vertex_count(); ++i) {
    const Vec3 p = particular.displacement(boundary_.mesh.vertices[i]);
    u[3 * i] += p.x, u[3 * i + 1] += p.y, u[3 * i + 2] += p.z;
  }
  modes_.add(u, modes_.coefficients(u), -1);
  return modes_.size(u);
}

std::size_t ElasticBody::bytes() const {
  if (!ready()) return 0;
  const std::size_t n = operator_->size();
  const std::lock_guard lock(factoring_);
  return operator_bytes_ + (factored_ ? FactoredInverse::bytes(n) : 0) +
         (deflation_ ? n * deflation_->dimension() * sizeof(Real) : 0);
}

Vec3Column ElasticBody::right_hand_side(const Load& load, const ParticularSolution& particular) const {
  const TraceScope scope("right-hand side");
  return testing_.apply(load_potential(boundary_, load, particular, material_, options_.quadrature, testing_.points()));
}

ElasticSolution ElasticBody::solve(const Load& load, const ParticularSolution& particular,
                                   SolutionHistory* history) const {
  ElasticSolution s;
  if (!ready()) {
    s.reason = reason_;
    return s;
  }
  const std::size_t n = boundary_.mesh.vertex_count();
  const Vec3Column rhs = right_hand_side(load, particular);
  std::vector<Real> b(3 * n), x(3 * n, 0);
  Real size2 = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) {
      b[3 * i + static_cast<std::size_t>(k)] = rhs[i][k];
      size2 += rhs[i][k] * rhs[i][k];
    }
  cavities_.add_load(boundary_, load, particular, material_.mu, b);
  if (!std::isfinite(size2)) {
    s.reason = "the load is not finite";
    return s;
  }
  if (history) s.warm = history->guess(b, x);
  {
    const TraceScope scope("iterate");
    s.krylov = iterate(b, x, s.factored);
  }
  if (history && s.krylov.status == KrylovStatus::kConverged) history->add(b, x);
  // The rigid part of the solution is arbitrary; its coefficient measures what did not balance.
  const std::array<Real, 6> c = modes_.coefficients(x);
  modes_.add(x, c, -1);
  const Real rigid = std::sqrt(std::inner_product(c.begin(), c.end(), c.begin(), Real{0})),
             strained = strained_size(x, particular);
  s.incompatibility = rigid > 0 ? rigid / std::hypot(rigid, strained) : 0;
  s.displacement.resize(n);
  bool finite = true;
  for (std::size_t i = 0; i < n; ++i) {
    s.displacement.set(i, {x[3 * i], x[3 * i + 1], x[3 * i + 2]});
    finite = finite && is_finite(s.displacement[i]);
  }
  s.ok = finite && s.krylov.status == KrylovStatus::kConverged;
  if (!s.ok)
    s.reason = fmt::format("the solver stopped after {} iterations at a relative residual of {:.2e} (asked for {:.1e})",
                           s.krylov.iterations, s.krylov.residual, options_.krylov.tolerance);
  return s;
}

}  // namespace sherd
