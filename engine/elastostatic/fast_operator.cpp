#include "engine/elastostatic/fast_operator.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/elastostatic/panel_rows.h"
#include "kernels/core/parallel.h"
#include "kernels/quadrature/gauss.h"

namespace sherd {

namespace {

// 1 and more: bulky. Ball and cube 1.9, bar 10:1 0.24, plate 100:1 0.07.
Real bulk(const Boundary& b) {
  return 20 * signed_volume(b.mesh) / (b.area * bounding_box(b.mesh).diagonal());
}

}  // namespace

bool is_bulky(const Boundary& b) {
  return bulk(b) >= 1;
}

Real far_tolerance(const Boundary& b) {
  return std::clamp(1e-5 * bulk(b) * bulk(b), 1e-8, 1e-5);
}

FastOperator::FastOperator(const Boundary& b, const Reconstruction& r, Real nu, const Testing& testing,
                           const FastOptions& o)
    : boundary_(b), reconstruction_(r), testing_(testing), near_(b, r, nu, testing) {
  Vec3Column normals(3 * b.panels.size());
  for (std::size_t i = 0; i < normals.size(); ++i) normals.set(i, b.panels[i / 3].normal);
  const LaneConstants c = lane_constants(nu);
  fmm::PlanOptions options;
  options.tolerance = o.tolerance, options.arithmetic = o.arithmetic, options.leaf_size = o.leaf_size;
  const Vec3Column sources = far_points(b.panels), targets = testing.points();
  plan_ =
      std::make_unique<fmm::Plan>(fmm::PairSum::kElasticValue, fmm::PairConstants<double>{c.one, c.two, c.angle, 0, 0},
                                  fmm::Points{sources, targets, &normals, nullptr}, options);
  Vec3Column ones(r.node_count());
  for (double& v : ones.x) v = 1;
  std::vector<double> value(3 * targets.size());
  std::vector<double> strength(6 * sources.size());
  strengths(ones, strength);
  plan_->apply(strength, value);
  total_ = near_.total();
  for (std::size_t i = 0; i < total_.size(); ++i) total_[i] += value[i];
}

std::size_t FastOperator::estimated_bytes(std::size_t triangles, std::size_t vertices, std::size_t tested) {
  // Measured on regular meshes: 260 blocks of 40 bytes a collocated row, twice as many a tested one; points with their
  // strengths, values and boxes, twelve points a tested vertex.
  const std::size_t points = 3 * triangles + vertices + 11 * tested;
  return (vertices + tested) * 11'000 + points * 250;
}

std::string FastOperator::too_large(const Boundary& b, const Testing& testing, std::size_t max_bytes) {
  const std::size_t bytes = estimated_bytes(b.panels.size(), b.mesh.vertex_count(), testing.galerkin_count());
  if (bytes <= max_bytes) return {};
  return fmt::format("{} triangles need an operator of about {} MiB, more than the {} MiB allowed: raise edge_length",
                     b.panels.size(), bytes >> 20, max_bytes >> 20);
}

void FastOperator::strengths(const Vec3Column& nodes, std::span<double> out) const {
  const std::size_t n = 3 * boundary_.panels.size();
  const NodeTables& table = node_tables();
  parallel_for(boundary_.panels.size(), 256, [&](std::size_t t) {
    const PanelFrame& f = boundary_.panels[t];
    const Vec3 gs = f.shape_gradient(1), gt = f.shape_gradient(2);
    for (std::size_t q = 0; q < 3; ++q) {
      Vec3 us, ut, u;  // means of the derivatives along the coordinates, and of the displacement, with the point's part
      for (std::size_t a = 0; a < cubic::kNodes; ++a) {
        const Vec3 v = nodes[reconstruction_.nodes(t)[a]];
        us += v * table.s[a][q], ut += v * table.t[a][q], u += v * table.shape[a][q];
      }
      const Vec3 guenter = gs * dot(f.normal, us) + gt * dot(f.normal, ut) - f.normal * (dot(gs, us) + dot(gt, ut));
      const std::size_t i = 3 * t + q;
      for (int k = 0; k < 3; ++k) {
        out[static_cast<std::size_t>(k) * n + i] = guenter[k] * f.area;
        out[static_cast<std::size_t>(3 + k) * n + i] = u[k] * f.area;
      }
    }
  });
}

void FastOperator::apply(std::span<const Real> x, std::span<Real> y) const {
  apply_sets(x, 1, y);
}

void FastOperator::apply_block(std::span<const Real> x, std::size_t count, std::span<Real> y) const {
  constexpr std::size_t kSets = 8;
  const std::size_t n = size();
  std::vector<Real> in, out;
  for (std::size_t first = 0; first < count; first += kSets) {
    const std::size_t sets = std::min(kSets, count - first);
    in.resize(sets * n), out.resize(sets * n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t s = 0; s < sets; ++s) in[s * n + i] = x[i * count + first + s];
    apply_sets(in, sets, out);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t s = 0; s < sets; ++s) y[i * count + first + s] = out[s * n + i];
  }
}

void FastOperator::apply_sets(std::span<const Real> x, std::size_t sets, std::span<Real> y) const {
  const std::size_t n = boundary_.mesh.vertex_count(), m = total_.size(), sources = 3 * boundary_.panels.size();
  std::vector<Vec3Column> u(sets, Vec3Column(n)), nodes(sets);
  std::vector<double> strength(sets * 6 * sources), far(sets * 3 * m);
  for (std::size_t s = 0; s < sets; ++s) {
    const std::span<const Real> in = x.subspan(s * size(), size());
    for (std::size_t v = 0; v < n; ++v) u[s].set(v, {in[3 * v], in[3 * v + 1], in[3 * v + 2]});
    reconstruction_.apply(u[s], nodes[s]);
    strengths(nodes[s], std::span(strength).subspan(s * 6 * sources, 6 * sources));
  }
  plan_->apply(strength, far, sets);
  for (std::size_t s = 0; s < sets; ++s) {
    const std::span<const double> values = std::span<const double>(far).subspan(s * 3 * m, 3 * m);
    const Vec3Column rows = testing_.apply(without_own(u[s], nodes[s], values));
    const std::span<Real> out = y.subspan(s * size(), size());
    for (std::size_t v = 0; v < n; ++v)
      for (int k = 0; k < 3; ++k) out[3 * v + static_cast<std::size_t>(k)] = rows[v][k];
    near_.add(x.subspan(s * size(), size()), out);
  }
}

// The far field at every point less u(x) D[1](x).
Vec3Column FastOperator::without_own(const Vec3Column& u, const Vec3Column& nodes, std::span<const double> far) const {
  const std::size_t m = total_.size(), first_gauss = testing_.collocated().size();
  Vec3Column value(m);
  parallel_for(m, 2048, [&](std::size_t i) {
    Vec3 own;
    if (i < first_gauss)
      own = u[testing_.collocated()[i]];
    else {
      const Testing::Point& p = testing_.gauss_points()[i - first_gauss];
      for (std::size_t a = 0; a < cubic::kNodes; ++a)
        own += nodes[reconstruction_.nodes(p.panel)[a]] * cubic::evaluate(cubic::kShape[a], p.s, p.t);
    }
    value.set(i, Vec3{far[i], far[m + i], far[2 * m + i]} - own * total_[i]);
  });
  return value;
}

Mat3 FastOperator::diagonal_block(std::size_t p) const {
  // The double layer of 1 at a smooth point of the surface is -1/2.
  const auto& c = testing_.collocated();
  const auto at = std::lower_bound(c.begin(), c.end(), p);
  const Real own = at != c.end() && *at == p ? total_[static_cast<std::size_t>(at - c.begin())] : -0.5;
  return near_.diagonal()[p] - Mat3::identity() * own;
}

}  // namespace sherd
