#include "engine/fracture/sheet_mesh.h"

#include <algorithm>

#include "engine/fracture/obstacles.h"
#include "engine/mesh/intersections.h"

namespace sherd {
namespace {

// Below this sine of the corner angle a triangle counts as degenerate: exact tests still work on it, offsetting does
// not.
constexpr Real kMinSine = 1e-3;

std::uint64_t cell_key(std::int64_t i, std::int64_t j, std::int64_t k) {
  constexpr std::uint64_t kMask = (1ull << 21) - 1;
  return (static_cast<std::uint64_t>(i) & kMask) | (static_cast<std::uint64_t>(j) & kMask) << 21 |
         (static_cast<std::uint64_t>(k) & kMask) << 42;
}

Box box_around(const std::array<Vec3, 3>& c, Real margin) {
  Box b;
  for (const Vec3& p : c) b.grow(p);
  const Vec3 m{margin, margin, margin};
  return {b.low - m, b.high + m};
}

}  // namespace

template <class F>
void BoxGrid::for_each_cell(const Box& box, const F& visit) const {
  std::int64_t low[3], high[3];
  for (int a = 0; a < 3; ++a) {
    low[a] = static_cast<std::int64_t>(std::floor(box.low[a] * inverse_cell_));
    high[a] = static_cast<std::int64_t>(std::floor(box.high[a] * inverse_cell_));
  }
  for (auto i = low[0]; i <= high[0]; ++i)
    for (auto j = low[1]; j <= high[1]; ++j)
      for (auto k = low[2]; k <= high[2]; ++k) visit(cell_key(i, j, k));
}

void BoxGrid::insert(std::uint32_t id, const Box& box) {
  if (seen_.size() <= id) seen_.resize(id + 1, 0);
  for_each_cell(box, [&](std::uint64_t key) { cells_[key].push_back(id); });
}

void BoxGrid::remove(std::uint32_t id, const Box& box) {
  for_each_cell(box, [&](std::uint64_t key) { std::erase(cells_[key], id); });
}

void BoxGrid::query(const Box& box, std::vector<std::uint32_t>& ids) const {
  ids.clear();
  ++query_;
  for_each_cell(box, [&](std::uint64_t key) {
    const auto cell = cells_.find(key);
    if (cell == cells_.end()) return;
    for (const std::uint32_t id : cell->second)
      if (seen_[id] != query_) seen_[id] = query_, ids.push_back(id);
  });
}

SheetMesh::SheetMesh(Real edge_length, Real clearance)
    : edge_(edge_length), clearance_(clearance), grid_(1.5 * edge_length) {}

std::uint32_t SheetMesh::add_node(const Vec3& p, const Vec3& n, NodeState s) {
  position.push_back(p), normal.push_back(n), state.push_back(s);
  met.push_back(kNoCrack), failures.push_back(0), pushes.push_back(0), stress_known.push_back(0), stress.push_back({}),
      moves.push_back(0), incident.emplace_back();
  return static_cast<std::uint32_t>(state.size() - 1);
}

Box SheetMesh::box_of(std::uint32_t t) const {
  Box b;
  for (const std::uint32_t v : triangles[t]) b.grow(position[v]);
  return b;
}

std::array<Vec3, 3> SheetMesh::corners_of(std::uint32_t t) const {
  const Triangle& n = triangles[t];
  return {position[n[0]], position[n[1]], position[n[2]]};
}

void SheetMesh::link(std::uint32_t t) {
  for (const std::uint32_t v : triangles[t]) incident[v].push_back(t);
  boxes_.resize(triangles.size());
  boxes_[t] = box_of(t);
  grid_.insert(t, boxes_[t]);
}

void SheetMesh::unlink(std::uint32_t t) {
  for (const std::uint32_t v : triangles[t]) std::erase(incident[v], t);
  grid_.remove(t, boxes_[t]);
}

bool SheetMesh::hidden(std::uint32_t t, const SheetEdit& edit) const {
  if (std::find(edit.remove.begin(), edit.remove.end(), t) != edit.remove.end()) return true;
  const Triangle& n = triangles[t];
  return edit.moved != kNone && (n[0] == edit.moved || n[1] == edit.moved || n[2] == edit.moved);
}

bool SheetMesh::make_trials(const SheetEdit& edit) {
  trials_.clear();
  const auto place = [&](std::uint32_t v) { return v == edit.moved ? edit.to : position[v]; };
  const auto append = [&](const Triangle& n) {
    trials_.push_back({n, {place(n[0]), place(n[1]), place(n[2])}, {}, {}});
    return trial_is_sound(trials_.back());
  };
  if (edit.moved != kNone)
    for (const std::uint32_t t : incident[edit.moved])
      if (std::find(edit.remove.begin(), edit.remove.end(), t) == edit.remove.end() && !append(triangles[t]))
        return false;
  return std::all_of(edit.add.begin(), edit.add.end(), append);
}

bool SheetMesh::trial_is_sound(Trial& trial) const {
  const auto& c = trial.corners;
  for (const Vec3& p : c)
    if (!is_finite(p)) return false;
  const Vec3 a = c[1] - c[0], b = c[2] - c[1], d = c[0] - c[2], n = cross(a, -d);
  const Real longest2 = std::max({norm2(a), norm2(b), norm2(d)}), area2 = norm(n);
  if (!(area2 > kMinSine * longest2) || !(area2 > 1e-6 * edge_ * edge_)) return false;
  const Vec3 mean = normal[trial.nodes[0]] + normal[trial.nodes[1]] + normal[trial.nodes[2]];
  if (!(dot(n, mean) > 0)) return false;
  trial.normal = n / area2;
  trial.outward = {normalized(cross(a, trial.normal)), normalized(cross(b, trial.normal)),
                   normalized(cross(d, trial.normal))};
  return true;
}

// A quick certain no for crowds(): the triangle is beyond one edge of the trial within its plane, or far above or
// below.
bool SheetMesh::lies_aside(const Trial& trial, const std::array<Vec3, 3>& corners) const {
  const auto& c = trial.corners;
  const auto all = [&](const Vec3& direction, const Vec3& from, Real beyond) {
    for (const Vec3& p : corners)
      if (dot(p - from, direction) < beyond) return false;
    return true;
  };
  for (std::size_t k = 0; k < 3; ++k)
    if (all(trial.outward[k], c[k], -1e-9 * edge_)) return true;
  return all(trial.normal, c[0], clearance_) || all(-trial.normal, c[0], clearance_);
}

// Layers that lie over each other keep the clearance between them, so that the slab does not meet itself; in a constant
// field arms that overlap are coplanar to rounding and only this sees it. Fronts that meet edge to edge may come close.
bool SheetMesh::crowds(const Trial& trial, const Triangle& nodes, const std::array<Vec3, 3>& corners) const {
  const auto lifted = [&](const Trial& t, std::size_t k, Real sign) {
    return t.corners[k] + sign * clearance_ * normal[t.nodes[k]];
  };
  const auto wall_meets = [&](const Trial& t, std::size_t k, const std::array<Vec3, 3>& other) {
    const std::size_t l = (k + 1) % 3;
    const Vec3 a = lifted(t, k, -1), b = lifted(t, l, -1), c = lifted(t, l, 1), d = lifted(t, k, 1);
    return triangles_intersect({a, b, c}, other) || triangles_intersect({a, c, d}, other);
  };
  std::size_t shared = 0, mine = 0, its = 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l)
      if (trial.nodes[k] == nodes[l]) ++shared, mine = k, its = l;
  if (shared > 1 || lies_aside(trial, corners)) return false;
  if (shared == 1)  // the edges opposite to the common node decide
    return wall_meets(trial, (mine + 1) % 3, corners) ||
           wall_meets({nodes, corners, {}, {}}, (its + 1) % 3, trial.corners);
  for (const Real sign : {-1.0, 1.0})
    if (triangles_intersect({lifted(trial, 0, sign), lifted(trial, 1, sign), lifted(trial, 2, sign)}, corners))
      return true;
  return wall_meets(trial, 0, corners) || wall_meets(trial, 1, corners) || wall_meets(trial, 2, corners);
}

bool SheetMesh::trial_is_clear(const Trial& trial, const SheetEdit& edit) {
  // Nothing of crowds() reaches farther than the clearance along an axis.
  const Box wide = box_around(trial.corners, 1.001 * clearance_), tight = box_around(trial.corners, 0);
  grid_.query(wide, candidates_);
  for (const std::uint32_t t : candidates_) {
    if (!boxes_[t].overlaps(wide) || hidden(t, edit)) continue;
    const Triangle& n = triangles[t];
    const std::array<Vec3, 3> c = corners_of(t);
    if (boxes_[t].overlaps(tight) && triangles_intersect(trial.nodes, trial.corners, n, c)) return false;
    if (crowds(trial, n, c)) return false;
  }
  return true;
}

bool SheetMesh::apply(const SheetEdit& edit) {
  if (!make_trials(edit)) return false;
  for (const Trial& trial : trials_)
    if (!trial_is_clear(trial, edit)) return false;
  for (std::size_t i = 0; i < trials_.size(); ++i)
    for (std::size_t j = i + 1; j < trials_.size(); ++j)
      if (triangles_intersect(trials_[i].nodes, trials_[i].corners, trials_[j].nodes, trials_[j].corners)) return false;
  for (const std::uint32_t t : edit.remove) unlink(t), alive[t] = 0;
  if (edit.moved != kNone) {
    const std::vector<std::uint32_t> touched = incident[edit.moved];
    for (const std::uint32_t t : touched) grid_.remove(t, boxes_[t]);
    position.set(edit.moved, edit.to);
    stress_known[edit.moved] = 0, ++moves[edit.moved];
    for (const std::uint32_t t : touched) boxes_[t] = box_of(t), grid_.insert(t, boxes_[t]);
  }
  for (const Triangle& n : edit.add) {
    triangles.push_back(n), alive.push_back(1);
    link(static_cast<std::uint32_t>(triangles.size() - 1));
  }
  return true;
}

bool SheetMesh::move(std::uint32_t node, const Vec3& to) {
  return apply({{}, {}, node, to});
}

bool SheetMesh::add(std::initializer_list<Triangle> list) {
  return apply({{}, list, kNone, {}});
}

bool SheetMesh::has_edge(std::uint32_t a, std::uint32_t b) const {
  return std::any_of(incident[a].begin(), incident[a].end(), [&](std::uint32_t t) {
    const Triangle& n = triangles[t];
    return n[0] == b || n[1] == b || n[2] == b;
  });
}

std::uint32_t SheetMesh::triangle_at(std::uint32_t a, std::uint32_t b) const {
  for (const std::uint32_t t : incident[a])
    for (std::size_t k = 0; k < 3; ++k)
      if (triangles[t][k] == a && triangles[t][(k + 1) % 3] == b) return t;
  return kNone;
}

std::vector<std::uint32_t> SheetMesh::neighbours(std::uint32_t v) const {
  std::vector<std::uint32_t> out;
  for (const std::uint32_t t : incident[v])
    for (const std::uint32_t n : triangles[t])
      if (n != v) out.push_back(n);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

bool SheetMesh::has_layer(std::uint32_t v, Real reach) {
  const Vec3 p = position[v], a = p - reach * normal[v], b = p + reach * normal[v];
  grid_.query(box_around({a, b, b}, 0), candidates_);
  const std::vector<std::uint32_t> ring = neighbours(v);
  const auto is_near = [&](std::uint32_t w) { return w == v || std::binary_search(ring.begin(), ring.end(), w); };
  return std::any_of(candidates_.begin(), candidates_.end(), [&](std::uint32_t t) {
    const Triangle& n = triangles[t];
    // The surroundings of a node whose crack turns sharply lie in its normal's way, too.
    if (is_near(n[0]) || is_near(n[1]) || is_near(n[2])) return false;
    return triangles_intersect({a, b, b}, corners_of(t));
  });
}

Vec3 SheetMesh::normal_of(std::uint32_t t) const {
  const std::array<Vec3, 3> c = corners_of(t);
  return normalized(cross(c[1] - c[0], c[2] - c[0]));
}

bool SheetMesh::first_hit(const Vec3& from, const Vec3& direction, Real length, const Vec3& plane, Real& t) {
  const Vec3 to = from + length * direction;
  grid_.query(box_around({from, to, to}, 0), candidates_);
  bool found = false;
  for (const std::uint32_t c : candidates_) {
    const Vec3 n = normal_of(c);
    const Real slope = dot(direction, n);
    if (!lies_across(n, plane) || slope == 0 || !triangles_intersect({from, to, to}, corners_of(c))) continue;
    const Real at = std::clamp(dot(corners_of(c)[0] - from, n) / slope, 0.0, length);
    if (!found || at < t) t = at;
    found = true;
  }
  return found;
}

bool SheetMesh::passes(const Vec3& x, Real reach, const Vec3& plane) {
  grid_.query(box_around({x, x, x}, reach), candidates_);
  return std::any_of(candidates_.begin(), candidates_.end(), [&](std::uint32_t t) {
    const std::array<Vec3, 3> c = corners_of(t);
    return !lies_across(normal_of(t), plane) &&
           distance2(closest_point_on_triangle(x, c[0], c[1], c[2]), x) < reach * reach;
  });
}

void SheetMesh::load(const CrackSheet& sheet) {
  for (std::size_t v = 0; v < sheet.state.size(); ++v) add_node(sheet.position[v], sheet.normal[v], sheet.state[v]);
  triangles = sheet.triangles;
  alive.assign(triangles.size(), 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) link(t);
}

CrackSheet SheetMesh::extract(const std::vector<std::vector<std::uint32_t>>& front) const {
  CrackSheet sheet;
  std::vector<std::uint32_t> map(state.size(), kNone);
  for (std::size_t v = 0; v < state.size(); ++v) {
    if (incident[v].empty()) continue;
    map[v] = static_cast<std::uint32_t>(sheet.state.size());
    sheet.position.push_back(position[v]), sheet.normal.push_back(normal[v]), sheet.state.push_back(state[v]);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (alive[t]) sheet.triangles.push_back({map[triangles[t][0]], map[triangles[t][1]], map[triangles[t][2]]});
  sheet.front = front;
  for (std::vector<std::uint32_t>& loop : sheet.front)
    for (std::uint32_t& v : loop) v = map[v];
  return sheet;
}

}  // namespace sherd
