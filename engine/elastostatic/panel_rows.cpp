#include "engine/elastostatic/panel_rows.h"

#include <numbers>

#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

constexpr int kExponent[kCubicMonomials][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1},
                                               {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}};

// Mean over the reference triangle of the product of two polynomials of degrees up to 3 and 2.
Real mean_product(const cubic::Polynomial& p, const cubic::Polynomial& q) {
  Real sum = 0;
  for (std::size_t a = 0; a < kCubicMonomials; ++a)
    for (std::size_t b = 0; b < kQuadraticMonomials; ++b)
      if (p[a] != 0 && q[b] != 0)
        sum += p[a] * q[b] * cubic::mean_monomial(kExponent[a][0] + kExponent[b][0], kExponent[a][1] + kExponent[b][1]);
  return sum;
}

// Polynomials of the first N monomials that are 1 at one point of the rule and 0 at the others (N = 3: linear, 6:
// quadratic), by Gauss-Jordan elimination of the Vandermonde matrix.
template <std::size_t N>
std::array<cubic::Polynomial, N> point_basis(const std::array<TrianglePoint, N>& rule) {
  Real m[N][2 * N] = {};
  for (std::size_t q = 0; q < N; ++q) {
    const auto v = cubic::monomials(rule[q].b, rule[q].c);
    for (std::size_t k = 0; k < N; ++k) m[q][k] = v[k];
    m[q][N + q] = 1;
  }
  for (std::size_t c = 0; c < N; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < N; ++r)
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    std::swap(m[c], m[pivot]);
    for (std::size_t r = 0; r < N; ++r) {
      if (r == c) continue;
      const Real f = m[r][c] / m[c][c];
      for (std::size_t k = 0; k < 2 * N; ++k) m[r][k] -= f * m[c][k];
    }
  }
  std::array<cubic::Polynomial, N> out{};
  for (std::size_t q = 0; q < N; ++q)
    for (std::size_t k = 0; k < N; ++k) out[q][k] = m[k][N + q] / m[k][k];
  return out;
}

// A shape function's part of tables: its weights over the points of a rule.
template <std::size_t N>
void point_weights(const cubic::Polynomial& shape, const std::array<cubic::Polynomial, N>& points, double (&s)[N],
                   double (&t)[N], double (&value)[N]) {
  const cubic::Polynomial ds = cubic::derivative(shape, 0), dt = cubic::derivative(shape, 1);
  for (std::size_t q = 0; q < N; ++q) {
    s[q] = mean_product(ds, points[q]), t[q] = mean_product(dt, points[q]);
    value[q] = mean_product(shape, points[q]);
  }
}

LaneTables make_tables() {
  static_assert(kPanelFreedoms == cubic::kFreedoms);
  LaneTables t{};
  const auto three = point_basis(kGauss3);
  const auto six = point_basis(kGauss6);
  for (std::size_t a = 0; a < kPanelFreedoms; ++a) {
    const auto &shape = cubic::kHermite[a], ds = cubic::derivative(shape, 0), dt = cubic::derivative(shape, 1);
    for (std::size_t m = 0; m < kQuadraticMonomials; ++m) t.monomial_s[a][m] = ds[m], t.monomial_t[a][m] = dt[m];
    for (std::size_t m = 0; m < kCubicMonomials; ++m) t.monomial_shape[a][m] = shape[m];
    point_weights(shape, three, t.three_s[a], t.three_t[a], t.three_shape[a]);
    point_weights(shape, six, t.six_s[a], t.six_t[a], t.six_shape[a]);
  }
  return t;
}

NodeTables make_node_tables() {
  NodeTables t{};
  const auto three = point_basis(kGauss3);
  for (std::size_t a = 0; a < cubic::kNodes; ++a) point_weights(cubic::kShape[a], three, t.s[a], t.t[a], t.shape[a]);
  return t;
}

void closed_form(const PanelFrame& f, const Vec3& x, Side side, const LaneConstants& c, std::size_t lane,
                 LaneMoments& out) {
  PanelMoments v;
  integrate_panel_moments(f, x, side, v);
  for (std::size_t m = 0; m < kQuadraticMonomials; ++m) {
    const Sym3 k = v.dyad[m] * c.two;
    const Real d = v.inverse[m] * c.one;
    const Real value[6] = {k.xx + d, k.yy + d, k.zz + d, k.yz, k.xz, k.xy};
    for (std::size_t i = 0; i < 6; ++i) out.kernel[m][i][lane] = value[i];
  }
  for (std::size_t m = 0; m < kCubicMonomials; ++m) out.angle[m][lane] = v.angle[m] * c.angle;
}

}  // namespace

const LaneTables& lane_tables() {
  static const LaneTables tables = make_tables();
  return tables;
}

const NodeTables& node_tables() {
  static const NodeTables tables = make_node_tables();
  return tables;
}

LaneConstants lane_constants(Real nu) {
  LaneConstants c;
  c.two = 1 / (8 * std::numbers::pi * (1 - nu));
  c.one = (3 - 4 * nu) * c.two - 1 / (4 * std::numbers::pi);
  c.angle = 1 / (4 * std::numbers::pi);
  return c;
}

void closed_forms(const PanelFrame& f, const double* x, const double* on, double* wanted, const LaneConstants& c,
                  const LaneKernels& kernels, LaneMoments& out) {
  kernels.panel_moments(f, c, x, on, wanted, out);
  for (std::size_t k = 0; k < kLanes; ++k)
    if (wanted[k] > 0)
      closed_form(f, {x[k], x[kLanes + k], x[2 * kLanes + k]}, on[k] > 0 ? Side::kOnSurface : Side::kAway, c, k, out);
}

void add_near_panel(const Boundary& b, const TargetGroup& g, std::uint32_t t, const LanePanel& panel,
                    const std::uint32_t* local, const LaneConstants& c, const LaneKernels& kernels, double* freedoms,
                    double* total) {
  const PanelFrame& f = b.panels[t];
  LaneMoments moments;
  double x[3 * kLanes], farther[3 * kLanes], mask[kLanes], near[kLanes], on[kLanes];
  bool others = false;
  const Vec3 away = f.vertex[0] + f.normal * (100 * std::sqrt(f.longest2));
  const Triangle& corner = b.mesh.triangles[t];
  for (std::size_t k = 0; k < kLanes; ++k) {
    const bool used = k < g.count;
    const Vec3& target = g.x[used ? k : 0];
    near[k] = used && distance2(g.x[k], b.centroid[t]) <= b.near2[t] ? 1 : 0;
    mask[k] = used && near[k] == 0 ? 1 : 0;
    others = others || mask[k] > 0;
    // A masked lane must not meet a source point: zero times infinity.
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = static_cast<int>(i);
      x[i * kLanes + k] = target[axis], farther[i * kLanes + k] = mask[k] > 0 ? target[axis] : away[axis];
    }
    on[k] =
        used && (g.panel[k] == t || (g.vertex[k] != kNone && (corner[0] == g.vertex[k] || corner[1] == g.vertex[k] ||
                                                              corner[2] == g.vertex[k])))
            ? 1
            : 0;
  }
  closed_forms(f, x, on, near, c, kernels, moments);
  kernels.moments(panel, lane_tables(), moments, local, freedoms, total);
  if (others) kernels.six_points(panel, lane_tables(), c, farther, mask, local, freedoms, total);
}

}  // namespace sherd
