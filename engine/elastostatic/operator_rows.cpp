#include "engine/elastostatic/operator_rows.h"

#include <algorithm>
#include <numbers>

#include "kernels/quadrature/gauss.h"

namespace sherd {
namespace {

// Three rows (of the displacement component) by three columns (of the unknown), each for all lanes.
struct LaneBlock {
  Lane m[3][3];
};
struct LaneVec {
  Lane v[3];
};

void add_scaled(LaneBlock& a, const LaneBlock& b, Real w) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a.m[i][j] += b.m[i][j] * w;
}

// Integrals of kernel times basis function b over one panel, b = 1 .. N: Kelvin-type kernel K (symmetric, order xx, yy,
// zz, yz, xz, xy) and, over the ten shape functions, the double layer.
template <int N>
struct PanelIntegrals {
  Lane kernel[N][6];
  Lane angle[cubic::kNodes];
};

// Coefficients of the shape functions' derivatives d/ds, d/dt in the basis the integrals use, and for the linear basis
// of the three-point rule the weights of the shape functions themselves.
template <int N>
struct BasisTable {
  Real s[cubic::kNodes][N], t[cubic::kNodes][N], shape[cubic::kNodes][N];
};

BasisTable<kQuadraticMonomials> monomial_table() {
  BasisTable<kQuadraticMonomials> out{};
  for (std::size_t a = 0; a < cubic::kNodes; ++a) {
    const auto s = cubic::derivative(cubic::kShape[a], 0), t = cubic::derivative(cubic::kShape[a], 1);
    for (std::size_t m = 0; m < kQuadraticMonomials; ++m) out.s[a][m] = s[m], out.t[a][m] = t[m];
  }
  return out;
}

// A kernel that varies linearly over the panel is integrated exactly against every shape function from its values at
// the three points of kGauss3: weight of point q = mean of (polynomial times 2 lambda_q - 1/3).
BasisTable<3> three_point_table() {
  constexpr int exponent[kCubicMonomials][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1},
                                                {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}};
  const auto mean = [&](const cubic::Polynomial& p, int q) {
    Real sum = 0;
    for (std::size_t m = 0; m < kCubicMonomials; ++m) {
      const int i = exponent[m][0], j = exponent[m][1];
      const Real one = cubic::mean_monomial(i, j), s = cubic::mean_monomial(i + 1, j),
                 t = cubic::mean_monomial(i, j + 1);
      const Real lambda = q == 0 ? one - s - t : (q == 1 ? s : t);
      sum += p[m] * (2 * lambda - one / 3);
    }
    return sum;
  };
  BasisTable<3> out{};
  for (std::size_t a = 0; a < cubic::kNodes; ++a)
    for (int q = 0; q < 3; ++q) {
      out.s[a][q] = mean(cubic::derivative(cubic::kShape[a], 0), q);
      out.t[a][q] = mean(cubic::derivative(cubic::kShape[a], 1), q);
      out.shape[a][q] = mean(cubic::kShape[a], q);
    }
  return out;
}

const BasisTable<kQuadraticMonomials> kMonomialTable = monomial_table();
const BasisTable<3> kThreePointTable = three_point_table();

struct Constants {
  Real one, two, angle;  // K = one I / l + two r r^T / l^3; double layer times angle
  explicit Constants(Real nu) {
    two = 1 / (8 * std::numbers::pi * (1 - nu));
    one = (3 - 4 * nu) * two - 1 / (4 * std::numbers::pi);
    angle = 1 / (4 * std::numbers::pi);
  }
};

struct LaneTargets {
  Lane x[3];
};

// Kernel and double-layer values of a source point at all targets, times w.
inline void point_values(const LaneTargets& targets, const Vec3& y, const Vec3& n, Real w, const Constants& c,
                         Lane kernel[6], Lane& angle) {
  const Lane r0 = targets.x[0] - y.x, r1 = targets.x[1] - y.y, r2 = targets.x[2] - y.z;
  const Lane l2 = r0 * r0 + r1 * r1 + r2 * r2;
  Lane inverse;
  for (std::size_t k = 0; k < kLanes; ++k) inverse[k] = 1 / std::sqrt(l2[k]);
  const Lane scaled = inverse * w, cube = scaled * inverse * inverse, diagonal = scaled * c.one, dyad = cube * c.two;
  const Lane d0 = dyad * r0, d1 = dyad * r1, d2 = dyad * r2;
  kernel[0] = diagonal + d0 * r0, kernel[1] = diagonal + d1 * r1, kernel[2] = diagonal + d2 * r2;
  kernel[3] = d1 * r2, kernel[4] = d0 * r2, kernel[5] = d0 * r1;
  angle = cube * (r0 * n.x + r1 * n.y + r2 * n.z) * c.angle;
}

void three_points(const PanelFrame& f, const LaneTargets& targets, const Constants& c, PanelIntegrals<3>& out) {
  Lane angle[3];
  for (std::size_t q = 0; q < 3; ++q) {
    const TrianglePoint& g = kGauss3[q];
    point_values(targets, f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c, f.normal, f.area, c, out.kernel[q],
                 angle[q]);
  }
  for (std::size_t a = 0; a < cubic::kNodes; ++a) {
    const Real* w = kThreePointTable.shape[a];
    out.angle[a] = angle[0] * w[0] + angle[1] * w[1] + angle[2] * w[2];
  }
}

void shape_angles(const Lane moment[kCubicMonomials], Lane angle[cubic::kNodes]) {
  for (std::size_t a = 0; a < cubic::kNodes; ++a) {
    Lane sum{};
    for (std::size_t m = 0; m < kCubicMonomials; ++m) sum += moment[m] * cubic::kShape[a][m];
    angle[a] = sum;
  }
}

// Moments of the monomials by the seven-point rule.
void seven_points(const PanelFrame& f, const LaneTargets& targets, const Constants& c,
                  Lane kernel[kQuadraticMonomials][6], Lane angle[kCubicMonomials]) {
  for (std::size_t m = 0; m < kQuadraticMonomials; ++m)
    for (int k = 0; k < 6; ++k) kernel[m][k] = Lane{};
  for (std::size_t m = 0; m < kCubicMonomials; ++m) angle[m] = Lane{};
  for (const TrianglePoint& g : kGauss7) {
    Lane value[6], w;
    point_values(targets, f.vertex[0] * g.a + f.vertex[1] * g.b + f.vertex[2] * g.c, f.normal, f.area * g.weight, c,
                 value, w);
    const auto m = cubic::monomials(g.b, g.c);
    for (std::size_t i = 0; i < kQuadraticMonomials; ++i)
      for (int k = 0; k < 6; ++k) kernel[i][k] += value[k] * m[i];
    for (std::size_t i = 0; i < kCubicMonomials; ++i) angle[i] += w * m[i];
  }
}

void closed_form(const PanelFrame& f, const Vec3& x, Side side, const Constants& c, std::size_t lane,
                 Lane kernel[kQuadraticMonomials][6], Lane angle[kCubicMonomials]) {
  PanelMoments v;
  integrate_panel_moments(f, x, side, v);
  for (std::size_t m = 0; m < kQuadraticMonomials; ++m) {
    const Sym3 k = v.dyad[m] * c.two;
    const Real d = v.inverse[m] * c.one;
    kernel[m][0][lane] = k.xx + d, kernel[m][1][lane] = k.yy + d, kernel[m][2][lane] = k.zz + d;
    kernel[m][3][lane] = k.yz, kernel[m][4][lane] = k.xz, kernel[m][5][lane] = k.xy;
  }
  for (std::size_t m = 0; m < kCubicMonomials; ++m) angle[m][lane] = v.angle[m] * c.angle;
}

inline LaneVec multiply(const Lane k[6], const Vec3& v) {
  return {{k[0] * v.x + k[5] * v.y + k[4] * v.z, k[5] * v.x + k[1] * v.y + k[3] * v.z,
           k[4] * v.x + k[3] * v.y + k[2] * v.z}};
}

// M u = sum over nodes (grad N_a n^T - n grad N_a^T) u_a: adds the panel's blocks to its ten nodes.
template <int N>
void scatter(const PanelFrame& f, const PanelIntegrals<N>& v, const BasisTable<N>& table,
             const std::array<std::uint32_t, cubic::kNodes>& nodes, std::vector<LaneBlock>& out) {
  const Vec3 gs = f.shape_gradient(1), gt = f.shape_gradient(2), n = f.normal;
  LaneVec ks[N], kt[N], kn[N];
  for (int b = 0; b < N; ++b)
    ks[b] = multiply(v.kernel[b], gs), kt[b] = multiply(v.kernel[b], gt), kn[b] = multiply(v.kernel[b], n);
  for (std::size_t a = 0; a < cubic::kNodes; ++a) {
    LaneBlock& block = out[nodes[a]];
    for (int i = 0; i < 3; ++i) {
      Lane p{}, vs{}, vt{};
      for (int b = 0; b < N; ++b) {
        p += ks[b].v[i] * table.s[a][b] + kt[b].v[i] * table.t[a][b];
        vs += kn[b].v[i] * table.s[a][b], vt += kn[b].v[i] * table.t[a][b];
      }
      block.m[i][0] += p * n.x - vs * gs.x - vt * gt.x;
      block.m[i][1] += p * n.y - vs * gs.y - vt * gt.y;
      block.m[i][2] += p * n.z - vs * gs.z - vt * gt.z;
      block.m[i][i] += v.angle[a];
    }
  }
}

// Panels that are near each other, with the nodes and corners they touch numbered locally, so that what one group of
// targets accumulates stays in the cache.
struct SourceBlock {
  std::vector<std::uint32_t> panels;
  std::vector<std::array<std::uint32_t, cubic::kNodes>> local;  // per panel
  std::vector<std::uint32_t> nodes, corners;                    // local -> global
  std::vector<std::uint32_t> term_corner;                       // of the nodes' terms in order: local corner
};

// Order of the panels along a space-filling curve (Morton).
std::vector<std::uint32_t> curve_order(const Boundary& b) {
  const Box box = bounding_box(b.mesh);
  const Real size = std::max(box.diagonal(), 1e-300);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> key(b.panels.size());
  for (std::uint32_t t = 0; t < key.size(); ++t) {
    const Vec3 p = (b.centroid[t] - box.low) * (1023 / size);
    std::uint64_t code = 0;
    for (int bit = 9; bit >= 0; --bit)
      for (int k = 0; k < 3; ++k) code = 2 * code + ((static_cast<std::uint64_t>(p[k]) >> bit) & 1);
    key[t] = {code, t};
  }
  std::sort(key.begin(), key.end());
  std::vector<std::uint32_t> order(key.size());
  for (std::size_t i = 0; i < key.size(); ++i) order[i] = key[i].second;
  return order;
}

constexpr std::size_t kBlockPanels = 128;

}  // namespace

struct OperatorRows::Impl {
  const Boundary& boundary;
  const Reconstruction& reconstruction;
  Constants constants;
  std::vector<SourceBlock> blocks;

  Impl(const Boundary& b, const Reconstruction& r, Real nu) : boundary(b), reconstruction(r), constants(nu) {
    const std::vector<std::uint32_t> order = curve_order(b);
    std::vector<std::uint32_t> node_of(r.node_count(), kNone), corner_of(r.corner_count(), kNone);
    for (std::size_t first = 0; first < order.size(); first += kBlockPanels) {
      SourceBlock block;
      for (std::size_t i = first; i < std::min(first + kBlockPanels, order.size()); ++i) {
        block.panels.push_back(order[i]);
        std::array<std::uint32_t, cubic::kNodes> local;
        for (std::size_t a = 0; a < cubic::kNodes; ++a) {
          std::uint32_t& slot = node_of[r.nodes(order[i])[a]];
          if (slot == kNone)
            slot = static_cast<std::uint32_t>(block.nodes.size()), block.nodes.push_back(r.nodes(order[i])[a]);
          local[a] = slot;
        }
        block.local.push_back(local);
      }
      for (const std::uint32_t node : block.nodes) {
        node_of[node] = kNone;
        if (node < r.vertex_count()) continue;
        for (const Reconstruction::Term& t : r.terms(node)) {
          std::uint32_t& slot = corner_of[t.corner];
          if (slot == kNone) slot = static_cast<std::uint32_t>(block.corners.size()), block.corners.push_back(t.corner);
          block.term_corner.push_back(slot);
        }
      }
      for (const std::uint32_t c : block.corners) corner_of[c] = kNone;
      blocks.push_back(std::move(block));
    }
  }
};

struct OperatorRows::Workspace {
  std::vector<LaneBlock> node, corner, vertex;
  Lane total;
};

OperatorRows::OperatorRows(const Boundary& boundary, const Reconstruction& reconstruction, Real nu)
    : impl_(std::make_unique<Impl>(boundary, reconstruction, nu)) {}
OperatorRows::~OperatorRows() = default;

std::shared_ptr<OperatorRows::Workspace> OperatorRows::make_workspace() const {
  return std::make_shared<Workspace>();
}

namespace {

using Workspace = OperatorRows::Workspace;

void add_panel(const Boundary& b, const TargetGroup& g, const LaneTargets& targets, std::uint32_t t,
               const std::array<std::uint32_t, cubic::kNodes>& local, const Constants& c, Workspace& w) {
  const PanelFrame& f = b.panels[t];
  bool near[kLanes], any_near = false, any_middle = false;
  for (std::size_t k = 0; k < kLanes; ++k) {
    const Real d2 = distance2(g.x[k], b.centroid[t]);
    near[k] = d2 <= b.near2[t];
    any_near = any_near || near[k], any_middle = any_middle || d2 <= b.middle2[t];
  }
  if (!any_middle) {
    PanelIntegrals<3> v;
    three_points(f, targets, c, v);
    for (const Lane& a : v.angle) w.total += a;
    scatter(f, v, kThreePointTable, local, w.node);
    return;
  }
  PanelIntegrals<kQuadraticMonomials> v;
  Lane angle[kCubicMonomials];
  bool all_near = true;
  for (std::size_t k = 0; k < g.count; ++k) all_near = all_near && near[k];
  if (!all_near) seven_points(f, targets, c, v.kernel, angle);
  if (any_near)
    for (std::size_t k = 0; k < g.count; ++k) {
      if (!near[k]) continue;
      const Triangle& corner = b.mesh.triangles[t];
      const bool on =
          g.panel == t ||
          (g.vertex[k] != kNone && (corner[0] == g.vertex[k] || corner[1] == g.vertex[k] || corner[2] == g.vertex[k]));
      closed_form(f, g.x[k], on ? Side::kOnSurface : Side::kAway, c, k, v.kernel, angle);
    }
  // Lanes without a target of their own repeat lane 0 in the rule and must not carry what a skipped rule left behind.
  for (std::size_t k = g.count; k < kLanes; ++k) {
    for (auto& m : v.kernel)
      for (Lane& e : m) e[k] = 0;
    for (Lane& e : angle) e[k] = 0;
  }
  shape_angles(angle, v.angle);
  w.total += angle[0];
  scatter(f, v, kMonomialTable, local, w.node);
}

// The transpose of the reconstruction: what the block's nodes gathered goes to vertices.
void gather(const Reconstruction& r, const SourceBlock& block, Workspace& w) {
  w.corner.assign(2 * block.corners.size(), LaneBlock{});
  std::size_t term = 0;
  for (std::size_t local = 0; local < block.nodes.size(); ++local) {
    const LaneBlock& n = w.node[local];
    const std::uint32_t node = block.nodes[local];
    if (node < r.vertex_count()) {
      add_scaled(w.vertex[node], n, 1);
      continue;
    }
    for (const Reconstruction::Entry& e : r.entries(node)) add_scaled(w.vertex[e.vertex], n, e.weight);
    for (const Reconstruction::Term& t : r.terms(node)) {
      const std::uint32_t c = block.term_corner[term++];
      const Reconstruction::Frame& f = r.frame(t.corner);
      LaneBlock &gx = w.corner[2 * c], &gy = w.corner[2 * c + 1];
      for (int i = 0; i < 3; ++i) {
        const Lane n0 = n.m[i][0] * t.z, n1 = n.m[i][1] * t.z, n2 = n.m[i][2] * t.z;
        for (int k = 0; k < 3; ++k) {
          gx.m[i][k] += n.m[i][k] * t.x + n0 * f.x[0][k] + n1 * f.x[1][k] + n2 * f.x[2][k];
          gy.m[i][k] += n.m[i][k] * t.y + n0 * f.y[0][k] + n1 * f.y[1][k] + n2 * f.y[2][k];
        }
      }
    }
  }
  for (std::size_t c = 0; c < block.corners.size(); ++c)
    for (const Reconstruction::GradientEntry& g : r.gradient(block.corners[c])) {
      LaneBlock& v = w.vertex[g.vertex];
      add_scaled(v, w.corner[2 * c], g.x), add_scaled(v, w.corner[2 * c + 1], g.y);
    }
}

// The term - u(x) D[1](x), u(x) the vertex value or the shape functions at a point of a panel.
void subtract_own(const Reconstruction& r, const TargetGroup& g, Workspace& w) {
  if (g.panel == kNone) {
    for (std::size_t k = 0; k < g.count; ++k)
      for (int i = 0; i < 3; ++i) w.vertex[g.vertex[k]].m[i][i][k] -= w.total[k];
    return;
  }
  for (std::size_t a = 0; a < cubic::kNodes; ++a) {
    Lane weight{};
    for (std::size_t k = 0; k < g.count; ++k)
      weight[k] = w.total[k] * cubic::evaluate(cubic::kShape[a], g.s[k], g.t[k]);
    for (const auto& [v, block] : r.row(r.nodes(g.panel)[a]))
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) w.vertex[v].m[i][j] -= weight * block[i][j];
  }
}

}  // namespace

void OperatorRows::evaluate(const TargetGroup& g, Workspace& w, std::span<Real> rows) const {
  const Boundary& b = impl_->boundary;
  const Reconstruction& r = impl_->reconstruction;
  LaneTargets targets;
  for (std::size_t k = 0; k < kLanes; ++k)
    for (int i = 0; i < 3; ++i) targets.x[i][k] = g.x[k < g.count ? k : 0][i];
  w.vertex.assign(r.vertex_count(), LaneBlock{});
  w.total = Lane{};
  for (const SourceBlock& block : impl_->blocks) {
    w.node.assign(block.nodes.size(), LaneBlock{});
    for (std::size_t i = 0; i < block.panels.size(); ++i)
      add_panel(b, g, targets, block.panels[i], block.local[i], impl_->constants, w);
    gather(r, block, w);
  }
  subtract_own(r, g, w);
  const std::size_t columns = 3 * r.vertex_count();
  for (std::size_t v = 0; v < r.vertex_count(); ++v)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) {
        const Lane& value = w.vertex[v].m[i][j];
        for (std::size_t k = 0; k < g.count; ++k) rows[(3 * k + i) * columns + 3 * v + j] = value[k];
      }
}

}  // namespace sherd
