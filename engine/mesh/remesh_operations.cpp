#include <algorithm>
#include <numbers>

#include "engine/mesh/intersections.h"
#include "engine/mesh/remesh_work.h"

namespace sherd {
namespace {

constexpr Real kDegree = std::numbers::pi / 180;
const Real kCosTurn = std::cos(30 * kDegree);  // how far an operation may turn a face
const Real kCosFold = std::cos(80 * kDegree);  // dihedral turn a smooth edge should not exceed
constexpr Real kSliver = 1e-3;                 // altitude / longest edge below which a face's own normal is not trusted
constexpr Real kTiny = 0.02;      // of the target length: features closer than this may be merged to remove a sliver
constexpr Real kVanishing = 0.1;  // of the target length: thinner faces do not show which way a sheet looks
constexpr Real kSpeck = 2e-3;     // of the target length
constexpr Real kOpposite = -0.7, kAlike = 0.9;  // cosines between normals
constexpr Real kPoorAngle = 10 * kDegree;       // operations may make faces this poor at most, or as poor as before

Vec3 area_normal(const std::array<Vec3, 3>& c) {
  return cross(c[1] - c[0], c[2] - c[0]);
}

Real longest2(const std::array<Vec3, 3>& c) {
  return std::max({distance2(c[0], c[1]), distance2(c[1], c[2]), distance2(c[2], c[0])});
}

}  // namespace

Real smallest_angle(const std::array<Vec3, 3>& c) {
  const Real e[3] = {distance2(c[1], c[2]), distance2(c[2], c[0]), distance2(c[0], c[1])};
  const std::size_t k = e[0] <= e[1] && e[0] <= e[2] ? 0 : (e[1] <= e[2] ? 1 : 2);
  const Vec3 u = c[(k + 1) % 3] - c[k], v = c[(k + 2) % 3] - c[k];
  return std::atan2(norm(cross(u, v)), dot(u, v));
}

Real Remesher::arc_on(std::uint32_t line, std::uint32_t v) const {
  if (features_.role[v] == VertexRole::kLine && features_.line[v] == line) return features_.arc[v];
  return features_.lines[line].nearest(mesh_.position[v]);
}

Vec3 Remesher::area_around(std::uint32_t v) const {
  Vec3 n;
  mesh_.for_out(v, [&](std::uint32_t h) { n += area_normal(mesh_.corners(h / 3)); });
  return 0.5 * n;
}

Vec3 Remesher::vertex_normal(std::uint32_t v) const {
  return normalized(area_around(v));
}

void Remesher::ring(std::uint32_t v, Patch& patch) const {
  mesh_.for_out(v, [&](std::uint32_t h) {
    const std::uint32_t a = mesh_.to(h), b = mesh_.tip(h);
    patch.push_back(
        {{v, a, b}, {mesh_.position[v], mesh_.position[a], mesh_.position[b]}, h / 3, mesh_.line[h] != kNone});
  });
}

// Faces around from(h) without the two at h, then those around to(h): one circle around the vertex that stays.
void Remesher::collapse_patch(std::uint32_t h, Patch& before, Patch& after) const {
  before.clear(), after.clear();
  const std::uint32_t b = mesh_.to(h), t = mesh_.twin[h];
  for (const auto& [start, end] : {std::pair{h, h}, std::pair{t, t}}) {
    std::uint32_t x = mesh_.turn(start);
    for (; mesh_.turn(x) != end; x = mesh_.turn(x)) {
      const std::uint32_t p = mesh_.to(x), q = mesh_.tip(x), v = mesh_.from(x);
      const Vec3 &pp = mesh_.position[p], &pq = mesh_.position[q];
      const bool crease = mesh_.line[x] != kNone;
      before.push_back({{v, p, q}, {mesh_.position[v], pp, pq}, x / 3, crease});
      after.push_back({{b, p, q}, {mesh_.position[b], pp, pq}, x / 3, crease});
    }
  }
}

bool Remesher::normal_agrees(const NewFace& after, const std::array<Vec3, 3>& before, bool repairing) const {
  const Vec3 n = area_normal(after.corner), o = area_normal(before);
  const Real ln = norm(n), lo = norm(o);
  if (!(ln > 0)) return false;
  const Real l2 = longest2(before);
  const Real tiny = merge_ * target(after.vertex[0]);
  if (lo > kSliver * l2 && !(repairing && lo * lo < tiny * tiny * l2)) return dot(n, o) > kCosTurn * ln * lo;
  // A sliver, or (in repair) a face thinner than anything the target length can show: ask the input surface.
  const Vec3 centre = (after.corner[0] + after.corner[1] + after.corner[2]) / 3.0;
  const std::uint32_t f = after.face;
  const auto found = project(centre, {0, 0, 0}, mesh_.region[f]);
  if (!found) return false;
  const Vec3 m = area_normal(input_bvh_.corners(found->face));
  return dot(n, m) > 0.5 * ln * norm(m);
}

bool Remesher::turns_little(const Patch& before, const Patch& after, bool repairing) const {
  for (std::size_t i = 0; i < after.size(); ++i)
    if (!normal_agrees(after[i], before[i].corner, repairing)) return false;
  const Real fold = worst_fold(after);
  return fold > kCosFold || fold >= worst_fold(before);
}

// Smallest cosine between normals across the smooth edges inside the patch and on its outline.
Real Remesher::worst_fold(const Patch& patch) const {
  Real worst = 1;
  const std::size_t n = patch.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = normalized(area_normal(patch[i].corner));
    if (!patch[i].crease) worst = std::min(worst, dot(a, normalized(area_normal(patch[(i + n - 1) % n].corner))));
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t h = 3 * patch[i].face + k;
      if (mesh_.from(h) != patch[i].vertex[1] || mesh_.to(h) != patch[i].vertex[2] || mesh_.line[h] != kNone) continue;
      worst = std::min(worst, dot(a, normalized(area_normal(mesh_.corners(mesh_.twin[h] / 3)))));
    }
  }
  return worst;
}

// No new face meets a face that stays, nor another new one.
bool Remesher::clear(const Patch& after, const std::vector<std::uint32_t>& replaced) {
  for (std::size_t i = 0; i < after.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (triangles_intersect(after[i].vertex, after[i].corner, after[j].vertex, after[j].corner))
        return ++report_.blocked, false;
    tree_.overlapping(box_of(after[i].corner), near_);
    for (const std::uint32_t f : near_)
      if (std::find(replaced.begin(), replaced.end(), f) == replaced.end() &&
          triangles_intersect(after[i].vertex, after[i].corner, mesh_.triangle[f], mesh_.corners(f)))
        return ++report_.blocked, false;
  }
  return true;
}

// Faces around the two ends look in opposite directions, and neither end has faces like the other's already: the edge
// spans a thin sheet. A vertex of three faces this close spans none: it is the cut-off tip of a
// corner.
bool Remesher::pinches_a_sheet(std::uint32_t h) const {
  if (mesh_.edge_length(h) < kSpeck * edge_target(h) && mesh_.valence(mesh_.from(h)) == 3) return false;
  // Faces about to vanish say nothing.
  const Real tiny = std::min(merge_, kVanishing) * edge_target(h);
  const auto normals = [&](std::uint32_t v) {
    std::vector<Vec3> around;
    mesh_.for_out(v, [&](std::uint32_t x) {
      const auto c = mesh_.corners(x / 3);
      const Vec3 n = area_normal(c);
      if (norm2(n) > tiny * tiny * longest2(c)) around.push_back(normalized(n));
    });
    return around;
  };
  const auto has_like = [](const std::vector<Vec3>& around, const Vec3& n) {
    return std::any_of(around.begin(), around.end(), [&](const Vec3& m) { return dot(n, m) > kAlike; });
  };
  const std::vector<Vec3> here = normals(mesh_.from(h)), there = normals(mesh_.to(h));
  for (const Vec3& n : here)
    for (const Vec3& m : there)
      if (dot(n, m) < kOpposite && !has_like(there, n) && !has_like(here, m)) return true;
  return false;
}

bool Remesher::may_collapse(std::uint32_t h, bool repairing) const {
  const std::uint32_t a = mesh_.from(h), b = mesh_.to(h);
  if (locked(a)) return false;
  if (features_.role[a] == VertexRole::kFree) return true;
  if (features_.role[a] == VertexRole::kLine && mesh_.line[h] == features_.line[a]) return true;
  // Features closer than anything the target length can show: only to remove a sliver, and across a thin sheet only one
  // that must go.
  if (!repairing || !(distance(mesh_.position[a], mesh_.position[b]) < merge_ * edge_target(h))) return false;
  return edge_angle(h) < options_.pinch_below * kDegree || !pinches_a_sheet(h);
}

// The smallest angle of the two faces at an edge.
Real Remesher::edge_angle(std::uint32_t h) const {
  return std::min(smallest_angle(mesh_.corners(h / 3)), smallest_angle(mesh_.corners(mesh_.twin[h] / 3)));
}

bool Remesher::try_collapse(std::uint32_t h, bool repairing) {
  if (!may_collapse(h, repairing) || !mesh_.can_collapse(h)) return false;
  const std::uint32_t a = mesh_.from(h), b = mesh_.to(h);
  collapse_patch(h, before_, after_);
  const Real limit = 4.0 / 3 * edge_target(h);
  Real old_longest = 0, new_longest = 0;
  Real old_angle = edge_angle(h);
  Real new_angle = std::numbers::pi;
  replaced_.assign({h / 3, mesh_.twin[h] / 3});
  for (std::size_t i = 0; i < after_.size(); ++i) {
    old_longest = std::max(old_longest, longest2(before_[i].corner));
    new_longest = std::max(new_longest, longest2(after_[i].corner));
    old_angle = std::min(old_angle, smallest_angle(before_[i].corner));
    new_angle = std::min(new_angle, smallest_angle(after_[i].corner));
    replaced_.push_back(before_[i].face);
  }
  if (!repairing && new_longest > limit * limit && new_longest > old_longest) return false;
  // In a cluster of tiny edges the first collapses cannot improve the angle yet; each still removes a vertex.
  const bool tiny = repairing && distance(mesh_.position[a], mesh_.position[b]) < kTiny * edge_target(h);
  // Nor in a strip of equal needles, which only merging looks for; the margin is for rounding.
  const Real gain = merge_ > kTiny ? 1 - 1e-9 : 1.0;
  if (new_angle < kPoorAngle && new_angle <= (tiny ? 0.3 : gain) * old_angle) return false;
  if (!turns_little(before_, after_, repairing) || !clear(after_, replaced_)) return false;
  // A vertex that joins two lines, or a line it was not part of, becomes a fixed one.
  const bool along = mesh_.line[h] != kNone && mesh_.line[h] == features_.line[a];
  if (features_.role[a] != VertexRole::kFree && !along) features_.role[b] = VertexRole::kFixed;
  tree_.remove(h / 3), tree_.remove(mesh_.twin[h] / 3);
  mesh_.collapse(h);
  for (const NewFace& f : after_) tree_.update(mesh_, f.face);
  ++report_.collapses;
  return true;
}

bool Remesher::try_split(std::uint32_t h, const Vec3& p, Real arc) {
  const std::uint32_t t = mesh_.twin[h], m = static_cast<std::uint32_t>(mesh_.position.size());
  const std::uint32_t v[4] = {mesh_.from(h), mesh_.tip(t), mesh_.to(h), mesh_.tip(h)};
  before_.clear(), after_.clear();
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t x = v[k], y = v[(k + 1) % 4], face = k < 2 ? t / 3 : h / 3;
    after_.push_back(
        {{m, x, y}, {p, mesh_.position[x], mesh_.position[y]}, face, mesh_.line[h] != kNone && k % 2 == 0});
    before_.push_back(after_.back());
    before_.back().corner = mesh_.corners(face);
    if (!normal_agrees(after_[k], before_[k].corner, false)) return false;
  }
  replaced_.assign({h / 3, t / 3});
  if (!clear(after_, replaced_)) return false;
  const std::uint32_t line = mesh_.line[h];
  mesh_.split(h, p);
  features_.role.push_back(line == kNone ? VertexRole::kFree : VertexRole::kLine);
  features_.line.push_back(line);
  features_.arc.push_back(arc);
  if (!size_.empty()) size_.push_back(0.5 * (target(v[0]) + target(v[2])));
  const auto count = static_cast<std::uint32_t>(mesh_.triangle.size());
  tree_.update(mesh_, h / 3), tree_.update(mesh_, t / 3);
  tree_.add(mesh_, count - 2), tree_.add(mesh_, count - 1);
  ++report_.splits;
  return true;
}

bool Remesher::try_flip(std::uint32_t h) {
  const std::uint32_t t = mesh_.twin[h], a = mesh_.from(h), b = mesh_.to(h), c = mesh_.tip(h), d = mesh_.tip(t);
  const Vec3 &pa = mesh_.position[a], &pb = mesh_.position[b], &pc = mesh_.position[c], &pd = mesh_.position[d];
  const Vec3 n0 = area_normal({pa, pb, pc}), n1 = area_normal({pb, pa, pd}), mean = normalized(n0 + n1);
  const Vec3 m0 = area_normal({pa, pd, pc}), m1 = area_normal({pb, pc, pd});
  if (dot(m0, mean) <= kCosTurn * norm(m0) || dot(m1, mean) <= kCosTurn * norm(m1)) return false;
  if (!mesh_.can_flip(h)) return false;
  after_.clear();
  after_.push_back({{a, d, c}, {pa, pd, pc}, h / 3, false});
  after_.push_back({{b, c, d}, {pb, pc, pd}, t / 3, false});
  replaced_.assign({h / 3, t / 3});
  if (!clear(after_, replaced_)) return false;
  mesh_.flip(h);
  tree_.update(mesh_, h / 3), tree_.update(mesh_, t / 3);
  ++report_.flips;
  return true;
}

bool Remesher::try_move(std::uint32_t v, const Vec3& p, Real keep) {
  before_.clear();
  ring(v, before_);
  after_ = before_;
  replaced_.clear();
  Real old_angle = std::numbers::pi, new_angle = std::numbers::pi;
  for (std::size_t i = 0; i < after_.size(); ++i) {
    after_[i].corner[0] = p;
    replaced_.push_back(after_[i].face);
    old_angle = std::min(old_angle, smallest_angle(before_[i].corner));
    new_angle = std::min(new_angle, smallest_angle(after_[i].corner));
  }
  if (new_angle < 3 * kPoorAngle && new_angle < keep * old_angle) return false;
  if (!turns_little(before_, after_, false) || !clear(after_, replaced_)) return false;
  mesh_.position[v] = p;
  for (const NewFace& f : after_) tree_.update(mesh_, f.face);
  ++report_.moves;
  return true;
}

}  // namespace sherd
