#include <algorithm>
#include <numbers>

#include "engine/mesh/remesh_work.h"

namespace sherd {
namespace {

constexpr Real kDegree = std::numbers::pi / 180;
constexpr Real kMerge = 0.02;    // what is merged from the start
constexpr Real kLeastChart = 8;  // of the target length squared: smaller charts' borders are no lines

struct EdgeKey {
  Real length;            // over its target, times the mesh's
  std::uint32_t h, a, b;  // the half-edge and its ends when the pass began
};

template <class F>
std::vector<EdgeKey> edges(const EditMesh& mesh, Real low, Real high, const F& scale) {
  std::vector<EdgeKey> keys;
  for (std::uint32_t h = 0; h < mesh.twin.size(); ++h) {
    if (!mesh.alive(h / 3) || h > mesh.twin[h]) continue;
    const Real length = mesh.edge_length(h) * scale(h);
    if (length > low && length < high) keys.push_back({length, h, mesh.from(h), mesh.to(h)});
  }
  return keys;
}

bool still_there(const EditMesh& mesh, const EdgeKey& k) {
  return mesh.alive(k.h / 3) && mesh.from(k.h) == k.a && mesh.to(k.h) == k.b;
}

// What a TriangleBvh asks of the first n faces.
SurfaceMesh first_faces(const SurfaceMesh& mesh, std::size_t n) {
  SurfaceMesh part;
  part.vertices = mesh.vertices;
  part.triangles.assign(mesh.triangles.begin(), mesh.triangles.begin() + static_cast<std::ptrdiff_t>(n));
  return part;
}

int valence_error(std::size_t valence) {
  return std::abs(static_cast<int>(valence) - 6);
}

}  // namespace

Remesher::Remesher(const SurfaceMesh& in, std::size_t real_faces, EditMesh mesh, const RemeshOptions& options,
                   RemeshReport& report)
    : mesh_(std::move(mesh)),
      options_(options),
      report_(report),
      locked_(options.locked),
      input_(in),
      input_bvh_(first_faces(in, real_faces)),
      input_region_(label_regions(in, options.keep_seams, kLeastChart * options.edge_length * options.edge_length)),
      size_(options.size),
      h_(options.edge_length),
      merge_(std::min(options.merge, kMerge)) {
  mesh_.region = input_region_;
  mesh_.first_ghost = static_cast<std::uint32_t>(real_faces);
  mesh_.end_ghost = static_cast<std::uint32_t>(in.triangle_count());
  features_ = find_feature_lines(mesh_, options.feature_angle, h_, options.locked);
}

bool Remesher::untouched(std::uint32_t face) const {
  if (face >= input_.triangle_count() || mesh_.triangle[face] != input_.triangles[face]) return false;
  const Triangle& f = input_.triangles[face];
  return std::all_of(f.begin(), f.end(), [&](std::uint32_t v) { return mesh_.position[v] == input_.vertices[v]; });
}

void Remesher::run() {
  tree_.build(mesh_);
  if (options_.iterations > 0) collapse_short();
  repair(2 * kDegree);
  for (int i = 0; i < options_.iterations; ++i) {
    tree_.build(mesh_);
    split_long();
    collapse_short();
    flip_all();
    smooth_all();
    update_sizes();
    repair(i + 1 == options_.iterations ? 20 * kDegree : 5 * kDegree);
  }
  if (options_.iterations > 0) smooth_all();
  for (int i = 0; i < 3; ++i) repair(20 * kDegree);
  // The closest features first: what they leave may be good enough.
  while (merge_ < options_.merge) {
    merge_ = std::min(2 * merge_, options_.merge);
    for (int i = 0; i < 3; ++i) {
      const std::size_t before = report_.collapses + report_.flips + report_.moves;
      repair(20 * kDegree);
      if (report_.collapses + report_.flips + report_.moves == before) break;
      if (options_.iterations > 0) flip_all(), smooth_all();
    }
    repair(20 * kDegree);
  }
  if (options_.keep_volume && options_.iterations > 0) fit_heights();
  if (options_.keep_volume) fit_volume();
}

std::optional<TriangleBvh::Closest> Remesher::project(const Vec3& p, const Vec3& n, std::uint32_t region) const {
  const auto fits = [&](std::uint32_t f) {
    if (input_region_[f] != region) return false;
    return n == Vec3{} || dot(input_.area_normal2(f), n) > 0.2 * norm(input_.area_normal2(f));
  };
  TriangleBvh::Closest best = input_bvh_.closest(p);
  if (best.face == kNone || fits(best.face)) return best;
  const Real reach = std::sqrt(best.distance2) + 0.5 * h_;
  std::vector<std::uint32_t> faces;
  input_bvh_.overlapping({p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}}, faces);
  best = {};
  for (const std::uint32_t f : faces) {
    if (!fits(f)) continue;
    const auto& c = input_bvh_.corners(f);
    const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
    if (distance2(p, q) < best.distance2) best = {q, f, distance2(p, q)};
  }
  if (best.face == kNone) return std::nullopt;
  return best;
}

Real Remesher::size_at(const TriangleBvh::Closest& on_input) const {
  const Triangle& t = input_.triangles[on_input.face];
  const auto& c = input_bvh_.corners(on_input.face);
  const Vec3 n = cross(c[1] - c[0], c[2] - c[0]), p = on_input.point;
  const Real area2 = norm2(n);
  if (!(area2 > 0)) return options_.size[t[0]];
  Real sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
    sum += std::clamp(dot(cross(b - a, p - a), n) / area2, 0.0, 1.0) * options_.size[t[k]];
  }
  // The weights sum to 1 but for rounding, which may be large on slivers.
  const auto [low, high] = std::minmax({options_.size[t[0]], options_.size[t[1]], options_.size[t[2]]});
  return std::clamp(sum, low, high);
}

// New vertices start with the mean of their edge's ends, moved ones with what they had.
void Remesher::update_sizes() {
  if (size_.empty()) return;
  for (std::uint32_t v = 0; v < mesh_.position.size(); ++v)
    if (mesh_.out[v] != kNone) size_[v] = size_at(input_bvh_.closest(mesh_.position[v]));
}

void Remesher::collapse_short() {
  std::vector<EdgeKey> keys = edges(mesh_, -1, 0.8 * h_, [&](std::uint32_t h) { return h_ / edge_target(h); });
  std::sort(keys.begin(), keys.end(),
            [](const EdgeKey& a, const EdgeKey& b) { return a.length != b.length ? a.length < b.length : a.h < b.h; });
  for (const EdgeKey& k : keys) {
    if (!still_there(mesh_, k) || mesh_.edge_length(k.h) >= 0.8 * edge_target(k.h)) continue;
    const std::uint32_t t = mesh_.twin[k.h];
    const bool forward = features_.role[k.a] <= features_.role[k.b];
    if (!try_collapse(forward ? k.h : t, false)) try_collapse(forward ? t : k.h, false);
  }
}

void Remesher::split_long() {
  const Real limit = 4.0 / 3 * h_;
  // A long edge needs several rounds of halving.
  for (int round = 0; round < 40; ++round) {
    std::vector<EdgeKey> keys = edges(mesh_, limit, 1e300, [&](std::uint32_t h) { return h_ / edge_target(h); });
    std::sort(keys.begin(), keys.end(), [](const EdgeKey& a, const EdgeKey& b) {
      return a.length != b.length ? a.length > b.length : a.h < b.h;
    });
    const std::size_t before = report_.splits;
    for (const EdgeKey& k : keys) {
      if (!still_there(mesh_, k) || locked_edge(k.h)) continue;
      const std::uint32_t line = mesh_.line[k.h];
      if (line == kNone) {
        split_free_edge(k.h);
        continue;
      }
      const Real arc = 0.5 * (arc_on(line, k.a) + arc_on(line, k.b));
      try_split(k.h, features_.lines[line].at(arc), arc);
    }
    if (report_.splits == before) return;
  }
}

// At the midpoint lifted to the input surface, or at the midpoint itself when that is near.
void Remesher::split_free_edge(std::uint32_t h) {
  const Vec3 middle = 0.5 * (mesh_.position[mesh_.from(h)] + mesh_.position[mesh_.to(h)]);
  const auto normal = [&](std::uint32_t t) {
    const auto c = mesh_.corners(t);
    return cross(c[1] - c[0], c[2] - c[0]);
  };
  const std::uint32_t f = h / 3;
  const Vec3 n = normalized(normal(f) + normal(mesh_.twin[h] / 3));
  const auto found = project(middle, n, mesh_.region[f]);
  const Real h2 = edge_target(h) * edge_target(h);
  if (!found || found->distance2 > 0.25 * h2) return;
  // A midpoint far off the surface that cannot be lifted stays a long edge: fewer vertices rather than wrong ones.
  if (!try_split(h, found->point, 0) && found->distance2 < 0.0025 * h2) try_split(h, middle, 0);
}

void Remesher::flip_all() {
  for (int round = 0; round < 2; ++round)
    for (std::uint32_t h = 0; h < mesh_.twin.size(); ++h) {
      if (!mesh_.alive(h / 3) || h > mesh_.twin[h] || mesh_.line[h] != kNone || locked_edge(h)) continue;
      const std::uint32_t t = mesh_.twin[h], a = mesh_.from(h), b = mesh_.to(h), c = mesh_.tip(h), d = mesh_.tip(t);
      const Vec3 &pa = mesh_.position[a], &pb = mesh_.position[b], &pc = mesh_.position[c], &pd = mesh_.position[d];
      const Real before = std::min(smallest_angle({pa, pb, pc}), smallest_angle({pb, pa, pd}));
      const Real after = std::min(smallest_angle({pa, pd, pc}), smallest_angle({pb, pc, pd}));
      bool good = after > before * (1 + 1e-9) && before < 40 * kDegree;
      if (!good && after > 25 * kDegree && after > 0.7 * before) {
        const std::size_t va = mesh_.valence(a), vb = mesh_.valence(b), vc = mesh_.valence(c), vd = mesh_.valence(d);
        good = va > 3 && vb > 3 &&
               valence_error(va - 1) + valence_error(vb - 1) + valence_error(vc + 1) + valence_error(vd + 1) <
                   valence_error(va) + valence_error(vb) + valence_error(vc) + valence_error(vd);
      }
      if (good) try_flip(h);
    }
}

void Remesher::smooth_all() {
  for (int round = 0; round < 2; ++round)
    for (std::uint32_t v = 0; v < mesh_.position.size(); ++v) {
      if (mesh_.out[v] == kNone || locked(v)) continue;
      if (features_.role[v] == VertexRole::kLine) smooth_line_vertex(v);
      if (features_.role[v] == VertexRole::kFree) smooth_free_vertex(v);
    }
}

bool Remesher::smooth_line_vertex(std::uint32_t v) {
  const std::uint32_t line = features_.line[v];
  Real end[2] = {0, 0}, wanted[2] = {1, 1};
  std::size_t count = 0;
  mesh_.for_out(v, [&](std::uint32_t h) {
    if (mesh_.line[h] != line) return;
    if (count < 2) end[count] = arc_on(line, mesh_.to(h)), wanted[count] = edge_target(h);
    ++count;
  });
  if (count != 2) return false;
  // Where both parts are equally long in units of their targets.
  const Real share = wanted[1] / (wanted[0] + wanted[1]), goal = share * end[0] + (1 - share) * end[1];
  for (const Real step : {1.0, 0.4}) {
    const Real arc = features_.arc[v] + step * (goal - features_.arc[v]);
    if (std::abs(arc - features_.arc[v]) < 1e-3 * target(v)) return false;
    if (!try_move(v, features_.lines[line].at(arc))) continue;
    features_.arc[v] = arc;
    return true;
  }
  return false;
}

// Area-weighted mean of the centroids around: evens out the areas, in units of the target length squared.
Vec3 Remesher::smoothed_position(std::uint32_t v) const {
  Vec3 sum;
  Real weight = 0;
  mesh_.for_out(v, [&](std::uint32_t h) {
    const auto c = mesh_.corners(h / 3);
    const Real across = 0.5 * (target(mesh_.to(h)) + target(mesh_.tip(h))) / h_;
    const Real area = norm(cross(c[1] - c[0], c[2] - c[0])) / (across * across);
    sum += area * (c[0] + c[1] + c[2]) / 3.0;
    weight += area;
  });
  return weight > 0 ? sum / weight : mesh_.position[v];
}

bool Remesher::smooth_free_vertex(std::uint32_t v) {
  const Vec3 x = mesh_.position[v], n = vertex_normal(v);
  Vec3 d = smoothed_position(v) - x;
  d -= n * dot(d, n);
  const std::uint32_t f = mesh_.out[v] / 3;
  const Real h2 = target(v) * target(v);
  for (const Real step : {1.0, 0.4}) {
    const auto found = project(x + d * step, n, mesh_.region[f]);
    if (!found || found->distance2 > 0.25 * h2) continue;
    if (distance2(found->point, x) < 1e-6 * h2) return false;
    if (try_move(v, found->point)) return true;
  }
  return false;
}

// Worst faces first. Every success changes the neighbourhood, so a few rounds.
void Remesher::repair(Real angle) {
  for (int round = 0; round < 4; ++round) {
    std::vector<std::pair<Real, std::uint32_t>> bad;
    for (std::uint32_t t = 0; t < mesh_.triangle.size(); ++t)
      if (mesh_.alive(t)) {
        const Real a = smallest_angle(mesh_.corners(t));
        if (a < angle) bad.emplace_back(a, t);
      }
    std::sort(bad.begin(), bad.end());
    const std::size_t before = report_.collapses + report_.flips + report_.moves;
    for (const auto& [a, t] : bad)
      if (mesh_.alive(t) && smallest_angle(mesh_.corners(t)) < angle) repair_face(t, angle);
    if (report_.collapses + report_.flips + report_.moves == before) return;
  }
}

void Remesher::repair_face(std::uint32_t t, Real angle) {
  std::uint32_t h[3] = {3 * t, 3 * t + 1, 3 * t + 2};
  std::sort(h, h + 3, [&](std::uint32_t a, std::uint32_t b) {
    const Real la = mesh_.edge_length(a), lb = mesh_.edge_length(b);
    return la != lb ? la < lb : a < b;
  });
  const Real now = smallest_angle(mesh_.corners(t));
  // Needle: the short edge goes, along the feature line first.
  if (mesh_.edge_length(h[0]) < 0.6 * edge_target(h[0])) {
    const bool forward = features_.role[mesh_.from(h[0])] <= features_.role[mesh_.to(h[0])];
    const std::uint32_t twin = mesh_.twin[h[0]];
    if (try_collapse(forward ? h[0] : twin, true) || try_collapse(forward ? twin : h[0], true)) return;
  }
  // Cap: the long edge is flipped, or split at the foot of the height where it cannot be.
  for (const std::uint32_t e : {h[2], h[1]}) {
    if (mesh_.line[e] != kNone || locked_edge(e)) continue;
    const std::uint32_t o = mesh_.twin[e];
    const Vec3 &a = mesh_.position[mesh_.from(e)], &b = mesh_.position[mesh_.to(e)];
    const Vec3 &c = mesh_.position[mesh_.tip(e)], &d = mesh_.position[mesh_.tip(o)];
    const Real before = std::min(now, smallest_angle({b, a, d}));
    if (std::min(smallest_angle({a, d, c}), smallest_angle({b, c, d})) > before * 1.01 && try_flip(e)) return;
  }
  if (now < 0.5 * angle && split_cap(h[2])) return;
  if (!mesh_.alive(t)) return;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t v = mesh_.triangle[t][k];
    if (locked(v)) continue;
    if (features_.role[v] == VertexRole::kFree && smooth_free_vertex(v)) return;
    if (features_.role[v] == VertexRole::kLine && smooth_line_vertex(v)) return;
  }
}

// Splits edge h next to the opposite vertex v and merges the two: v moves to the line, or, when v is itself part of a
// feature and the gap is tiny, the new vertex moves to v.
bool Remesher::split_cap(std::uint32_t h) {
  const std::uint32_t line = mesh_.line[h], v = mesh_.tip(h);
  if (locked_edge(h)) return false;
  const Vec3 a = mesh_.position[mesh_.from(h)], b = mesh_.position[mesh_.to(h)], p = mesh_.position[v];
  const bool free = features_.role[v] == VertexRole::kFree && line != kNone;
  Real arc = 0;
  Vec3 foot = a + (b - a) * (dot(p - a, b - a) / distance2(a, b));
  if (line != kNone) {
    const FeatureLine& l = features_.lines[line];
    const Real s0 = arc_on(line, mesh_.from(h)), s1 = arc_on(line, mesh_.to(h));
    arc = std::clamp(l.nearest(p), std::min(s0, s1), std::max(s0, s1));
    foot = l.at(arc);
  }
  const Real size = target(v);
  if (!free && distance(foot, p) > merge_ * size) return false;
  if (std::min(distance(foot, a), distance(foot, b)) < 0.05 * size) return false;
  if (!try_split(h, foot, arc)) return false;
  const auto m = static_cast<std::uint32_t>(mesh_.position.size() - 1);
  const auto edge = [&](std::uint32_t from, const auto& wanted) {
    std::uint32_t found = kNone;
    mesh_.for_out(from, [&](std::uint32_t x) {
      if (wanted(x)) found = x;
    });
    return found;
  };
  const std::uint32_t across = edge(m, [&](std::uint32_t x) { return mesh_.to(x) == v; });
  if (try_collapse(free ? mesh_.twin[across] : across, true)) return true;
  // Take the split back.
  for (const Vec3& end : {a, b}) {
    const std::uint32_t back = edge(m, [&](std::uint32_t x) { return mesh_.position[mesh_.to(x)] == end; });
    if (back != kNone && try_collapse(back, true)) break;
  }
  return false;
}

}  // namespace sherd
