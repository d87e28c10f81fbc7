#include "engine/elastostatic/reconstruction.h"

#include <algorithm>
#include <map>
#include <optional>

#include "kernels/core/parallel.h"

namespace sherd {
namespace {

// w = -G n from g1 = G (a + slope_x n), g2 = G (b + slope_y n) and Hooke's sigma n = 0:
//   (n - k slope_x a - k slope_y b) w = k (a g1 + b g2),  (a - slope_x n) w = n g1,  (b - slope_y n) w = n g2
// with k = nu / (1 - nu). The rotation part alone keeps rigid motions exact (design notes, step 4); the rest is the
// thinning by Poisson's ratio.
Reconstruction::Frame free_surface_frame(const SurfaceFit& f, Real nu) {
  const Real k = nu / (1 - nu);
  const Vec3 a = f.a(), b = f.b(), n = f.normal();
  const Mat3 c = inverse(transpose(
      Mat3::from_columns(n - a * (k * f.slope_x()) - b * (k * f.slope_y()), a - n * f.slope_x(), b - n * f.slope_y())));
  const Vec3 cn = c * Vec3{1, 0, 0}, ca = c * Vec3{0, 1, 0}, cb = c * Vec3{0, 0, 1};
  return {outer(cn, a) * k + outer(ca, n), outer(cn, b) * k + outer(cb, n)};
}

// Corners, per vertex, whose fit knows the derivative across its surface: their patch has a vertex inside. On a strip
// one element wide, such as the rim of a vessel, all vertices lie on creases and a polynomial's derivative across is
// arbitrary where the strip is curved: a goblet became 12 % too stiff. There the derivative follows from the fit beside
// the crease, across it from the surface being free of traction.
std::vector<std::vector<std::uint32_t>> wide_corners(const SurfaceCorners& corners, const std::vector<SurfaceFit>& fits,
                                                     std::size_t vertices) {
  std::vector<std::uint8_t> sides(vertices, 0);  // 2: two or more
  for (const SurfaceCorner& c : corners.corner) sides[c.vertex] = sides[c.vertex] == 0 ? 1 : 2;
  std::vector<std::vector<std::uint32_t>> out(vertices);
  for (std::uint32_t c = 0; c < fits.size(); ++c)
    if (std::ranges::any_of(fits[c].patch(), [&](std::uint32_t v) { return sides[v] == 1; }))
      out[corners.corner[c].vertex].push_back(c);
  return out;
}

}  // namespace

Reconstruction::Reconstruction(const SurfaceMesh& mesh, Real nu, const ReconstructionOptions& options)
    : vertices_(mesh.vertex_count()), nodes_(mesh.triangle_count()), slopes_(mesh.triangle_count()) {
  for (std::size_t t = 0; t < nodes_.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) nodes_[t][k] = mesh.triangles[t][k];
  if (options.element == Element::kLinear) {
    add_linear_nodes(mesh);
    return;
  }
  const SurfaceCorners corners = make_surface_corners(mesh, options.feature_angle);
  std::vector<std::optional<SurfaceFit>> made(corners.corner.size());
  parallel_for(made.size(), 32, [&](std::size_t c) { made[c].emplace(mesh, corners, c, options.fit); });
  std::vector<SurfaceFit> fits;
  fits.reserve(made.size());
  for (auto& f : made) fits.push_back(std::move(*f));
  for (const SurfaceFit& f : fits) {
    frames_.push_back(free_surface_frame(f, nu));
    for (std::size_t k = 0; k < f.patch().size(); ++k) gradients_.push_back({f.patch()[k], f.row_x()[k], f.row_y()[k]});
    first_gradient_.push_back(gradients_.size());
  }
  add_edge_nodes(mesh, corners, fits);
  add_centres(mesh);
}

void Reconstruction::close_node() {
  node_entries_.push_back(entries_.size()), node_terms_.push_back(terms_.size());
}

std::uint32_t Reconstruction::close_slope() {
  slope_entries_.push_back(entries_of_slopes_.size()), slope_terms_.push_back(terms_of_slopes_.size());
  return static_cast<std::uint32_t>(slope_count() - 1);
}

// Hermite cubic along each edge; at a crease the mean of the fits of both sides, so that u stays continuous, which the
// Guenter form needs.
void Reconstruction::add_edge_nodes(const SurfaceMesh& mesh, const SurfaceCorners& corners,
                                    const std::vector<SurfaceFit>& fits) {
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  const std::vector<std::vector<std::uint32_t>> wide = wide_corners(corners, fits, vertices_);
  const auto prefer_wide = [&](std::vector<std::uint32_t>& ends) {
    const std::vector<std::uint32_t>& better = wide[corners.corner[ends.front()].vertex];
    const auto narrow = [&](std::uint32_t c) { return std::ranges::find(better, c) == better.end(); };
    if (better.empty()) return;
    if (std::ranges::all_of(ends, narrow)) ends = better;
    std::erase_if(ends, narrow);
  };
  for (std::uint32_t e = 0; e < twin.size(); ++e) {
    const std::uint32_t other = twin[e];
    if (other != kNone && other < e) continue;
    const std::size_t t = e / 3, k = e % 3, next = (k + 1) % 3;
    const std::uint32_t p = mesh.triangles[t][k], q = mesh.triangles[t][next];
    const Vec3 d = mesh.vertices[q] - mesh.vertices[p];
    std::vector<std::uint32_t> at_p{corners.at(t, k)}, at_q{corners.at(t, next)};
    if (other != kNone && corners.smooth[e] == kNone) {
      at_p.push_back(corners.at(other / 3, (other % 3 + 1) % 3));
      at_q.push_back(corners.at(other / 3, other % 3));
    }
    prefer_wide(at_p), prefer_wide(at_q);
    const auto make_slope = [&](const std::vector<std::uint32_t>& ends, const Vec3& along) {
      for (const std::uint32_t c : ends) {
        const SurfaceFit& f = fits[c];
        const Real w = 1 / static_cast<Real>(ends.size()), x = dot(along, f.a()), y = dot(along, f.b());
        const Real rise = x * f.slope_x() + y * f.slope_y() - dot(along, f.normal());
        terms_of_slopes_.push_back({c, w * x, w * y, w * rise});
      }
      return close_slope();
    };
    const std::uint32_t from_p = make_slope(at_p, d), from_q = make_slope(at_q, -d);
    slopes_[t][2 * k] = from_p, slopes_[t][2 * k + 1] = from_q;
    if (other != kNone) slopes_[other / 3][2 * (other % 3)] = from_q, slopes_[other / 3][2 * (other % 3) + 1] = from_p;
    for (int third = 1; third <= 2; ++third) {
      const Real l = third / 3.0, l2 = l * l, l3 = l2 * l, to_q = 3 * l2 - 2 * l3;
      entries_.push_back({p, 1 - to_q}), entries_.push_back({q, to_q});
      for (const auto& [slope, factor] : {std::pair{from_p, l - 2 * l2 + l3}, {from_q, l2 - l3}})
        for (const Term& m : slope_terms(slope)) terms_.push_back({m.corner, factor * m.x, factor * m.y, factor * m.z});
      const auto node = static_cast<std::uint32_t>(node_count());
      close_node();
      nodes_[t][3 + 2 * k + static_cast<std::size_t>(third - 1)] = node;
      if (other != kNone) nodes_[other / 3][3 + 2 * (other % 3) + static_cast<std::size_t>(2 - third)] = node;
    }
  }
}

// The centre that makes the element exact for quadratics: a quarter of the edge nodes minus a sixth of the vertices.
// The mean of the vertex polynomials, which is exact for cubics, measures no better on plates (1.13 to 1.41 % at q =
// 3, 7.6 to 6.7 % at q = 6, h/T = 2), worse on shells (1.46 to 1.04 %) and reaches forty vertices instead of the
// corners' own.
void Reconstruction::add_centres(const SurfaceMesh& mesh) {
  std::map<std::uint32_t, Real> entry;
  std::map<std::uint32_t, Term> term;
  for (std::size_t t = 0; t < nodes_.size(); ++t) {
    entry.clear(), term.clear();
    for (const std::uint32_t v : mesh.triangles[t]) entry[v] -= 1.0 / 6;
    for (std::size_t k = 3; k < 9; ++k) {
      for (const Entry& e : entries(nodes_[t][k])) entry[e.vertex] += e.weight / 4;
      for (const Term& m : terms(nodes_[t][k])) {
        Term& sum = term.try_emplace(m.corner, Term{m.corner, 0, 0, 0}).first->second;
        sum.x += m.x / 4, sum.y += m.y / 4, sum.z += m.z / 4;
      }
    }
    for (const auto& [v, w] : entry) entries_.push_back({v, w});
    for (const auto& [c, m] : term) terms_.push_back(m);
    nodes_[t][9] = static_cast<std::uint32_t>(node_count());
    close_node();
  }
}

void Reconstruction::add_linear_nodes(const SurfaceMesh& mesh) {
  for (std::size_t t = 0; t < nodes_.size(); ++t) {
    for (std::size_t k = 0; k < 6; ++k) {
      const std::uint32_t p = mesh.triangles[t][k / 2], q = mesh.triangles[t][(k / 2 + 1) % 3];
      const Real outward = k % 2 == 0 ? 1 : -1;
      entries_of_slopes_.push_back({p, -outward}), entries_of_slopes_.push_back({q, outward});
      slopes_[t][k] = close_slope();
    }
    for (std::size_t k = 0; k < 7; ++k) {
      const Triangle& v = mesh.triangles[t];
      if (k == 6)
        for (const std::uint32_t i : v) entries_.push_back({i, 1.0 / 3});
      else {
        const Real l = k % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
        entries_.push_back({v[k / 2], 1 - l}), entries_.push_back({v[(k / 2 + 1) % 3], l});
      }
      nodes_[t][3 + k] = static_cast<std::uint32_t>(node_count());
      close_node();
    }
  }
}

std::span<const Reconstruction::Entry> Reconstruction::entries(std::uint32_t node) const {
  const std::size_t i = node - vertices_;
  return {entries_.data() + node_entries_[i], node_entries_[i + 1] - node_entries_[i]};
}
std::span<const Reconstruction::Term> Reconstruction::terms(std::uint32_t node) const {
  const std::size_t i = node - vertices_;
  return {terms_.data() + node_terms_[i], node_terms_[i + 1] - node_terms_[i]};
}
std::span<const Reconstruction::Entry> Reconstruction::slope_entries(std::uint32_t slope) const {
  return {entries_of_slopes_.data() + slope_entries_[slope], slope_entries_[slope + 1] - slope_entries_[slope]};
}
std::span<const Reconstruction::Term> Reconstruction::slope_terms(std::uint32_t slope) const {
  return {terms_of_slopes_.data() + slope_terms_[slope], slope_terms_[slope + 1] - slope_terms_[slope]};
}
std::span<const Reconstruction::GradientEntry> Reconstruction::gradient(std::uint32_t corner) const {
  return {gradients_.data() + first_gradient_[corner], first_gradient_[corner + 1] - first_gradient_[corner]};
}

void Reconstruction::apply(const Vec3Column& u, Vec3Column& out) const {
  Vec3Column gx(corner_count()), gy(corner_count());
  parallel_for(corner_count(), 512, [&](std::size_t c) {
    Vec3 x, y;
    for (const GradientEntry& g : gradient(static_cast<std::uint32_t>(c)))
      x += u[g.vertex] * g.x, y += u[g.vertex] * g.y;
    gx.set(c, x), gy.set(c, y);
  });
  out.resize(node_count());
  parallel_for(node_count(), 512, [&](std::size_t i) {
    if (i < vertices_) {
      out.set(i, u[i]);
      return;
    }
    const auto node = static_cast<std::uint32_t>(i);
    Vec3 sum;
    for (const Entry& e : entries(node)) sum += u[e.vertex] * e.weight;
    for (const Term& t : terms(node)) {
      const Frame& f = frames_[t.corner];
      const Vec3 x = gx[t.corner], y = gy[t.corner];
      sum += x * t.x + y * t.y + (f.x * x + f.y * y) * t.z;
    }
    out.set(i, sum);
  });
}

Vec3Column Reconstruction::apply_transpose(const Vec3Column& nodes) const {
  Vec3Column out(vertices_), gx(corner_count()), gy(corner_count());
  for (std::uint32_t i = 0; i < node_count(); ++i) {
    const Vec3 f = nodes[i];
    if (i < vertices_) {
      out.add(i, f);
      continue;
    }
    for (const Entry& e : entries(i)) out.add(e.vertex, f * e.weight);
    for (const Term& t : terms(i)) {
      gx.add(t.corner, f * t.x + transpose(frames_[t.corner].x) * f * t.z);
      gy.add(t.corner, f * t.y + transpose(frames_[t.corner].y) * f * t.z);
    }
  }
  for (std::uint32_t c = 0; c < corner_count(); ++c)
    for (const GradientEntry& g : gradient(c)) out.add(g.vertex, gx[c] * g.x + gy[c] * g.y);
  return out;
}

std::vector<std::pair<std::uint32_t, Mat3>> Reconstruction::row(std::uint32_t node) const {
  if (node < vertices_) return {{node, Mat3::identity()}};
  std::map<std::uint32_t, Mat3> sum;
  for (const Entry& e : entries(node)) sum[e.vertex] += Mat3::identity() * e.weight;
  for (const Term& t : terms(node)) {
    const Frame& f = frames_[t.corner];
    for (const GradientEntry& g : gradient(t.corner))
      sum[g.vertex] += Mat3::identity() * (t.x * g.x + t.y * g.y) + (f.x * g.x + f.y * g.y) * t.z;
  }
  return {sum.begin(), sum.end()};
}

}  // namespace sherd
