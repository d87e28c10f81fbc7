#include "engine/mesh/remesh_lines.h"

#include <algorithm>
#include <numbers>

namespace sherd {
namespace {

enum : std::uint8_t { kNoFeature, kCrease, kBoundary };

class LineFinder {
 public:
  LineFinder(EditMesh& mesh, Real angle, Real edge_length, const std::vector<std::uint8_t>& locked)
      : mesh_(mesh), cos_angle_(std::cos(angle * std::numbers::pi / 180)), h_(edge_length), locked_(locked) {}

  FeatureLines run() {
    mark_edges();
    drop_specks();
    for (int pass = 0; pass < 3; ++pass) drop_stubs();
    result_.role.assign(mesh_.position.size(), VertexRole::kFree);
    result_.line.assign(mesh_.position.size(), kNone);
    result_.arc.assign(mesh_.position.size(), 0);
    for (std::uint32_t v = 0; v < mesh_.position.size(); ++v) {
      if (mesh_.out[v] == kNone) continue;
      const std::size_t degree = feature_degree(v);
      if (is_node(v, degree)) result_.role[v] = VertexRole::kFixed;
    }
    trace_all();
    return std::move(result_);
  }

 private:
  bool is_locked(std::uint32_t v) const { return !locked_.empty() && locked_[v] != 0; }
  bool is_node(std::uint32_t v, std::size_t degree) const { return is_locked(v) || (degree != 0 && degree != 2); }

  std::size_t feature_degree(std::uint32_t v) const {
    std::size_t n = 0;
    mesh_.for_out(v, [&](std::uint32_t h) { n += feature_[h] != kNoFeature; });
    return n;
  }

  void mark_edges() {
    feature_.assign(mesh_.twin.size(), kNoFeature);
    // A face so thin that rounding decides its normal borrows the one across its longest edge.
    std::vector<Vec3> normal(mesh_.triangle.size());
    std::vector<std::uint32_t> borrow(mesh_.triangle.size(), kNone);
    for (std::uint32_t t = 0; t < normal.size(); ++t) {
      const auto c = mesh_.corners(t);
      const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
      const Real e[3] = {mesh_.edge_length(3 * t), mesh_.edge_length(3 * t + 1), mesh_.edge_length(3 * t + 2)};
      const std::uint32_t k = e[0] >= e[1] && e[0] >= e[2] ? 0 : (e[1] >= e[2] ? 1 : 2);
      if (norm(n) <= 1e-9 * e[k] * e[k]) borrow[t] = mesh_.twin[3 * t + k] / 3;
      normal[t] = normalized(n);
    }
    for (std::uint32_t t = 0; t < normal.size(); ++t)
      if (borrow[t] != kNone) normal[t] = normal[borrow[t]];
    for (std::uint32_t h = 0; h < feature_.size(); ++h) {
      const std::uint32_t f = h / 3, g = mesh_.twin[h] / 3;
      if (mesh_.region[f] != mesh_.region[g])
        feature_[h] = kBoundary;
      else if (dot(normal[f], normal[g]) < cos_angle_)
        feature_[h] = kCrease;
    }
  }

  void clear(std::uint32_t h) { feature_[h] = feature_[mesh_.twin[h]] = kNoFeature; }

  // Connected sets of creases shorter than 3 h in all.
  void drop_specks() {
    std::vector<std::uint8_t> seen(mesh_.position.size(), 0);
    for (std::uint32_t seed = 0; seed < seen.size(); ++seed) {
      if (seen[seed] || mesh_.out[seed] == kNone || feature_degree(seed) == 0) continue;
      std::vector<std::uint32_t> vertices{seed}, edges;
      seen[seed] = 1;
      Real length = 0;
      bool boundary = false;
      for (std::size_t i = 0; i < vertices.size(); ++i)
        mesh_.for_out(vertices[i], [&](std::uint32_t h) {
          if (feature_[h] == kNoFeature) return;
          boundary = boundary || feature_[h] == kBoundary || is_locked(vertices[i]);
          if (h < mesh_.twin[h]) length += mesh_.edge_length(h), edges.push_back(h);
          const std::uint32_t w = mesh_.to(h);
          if (!seen[w]) seen[w] = 1, vertices.push_back(w);
        });
      if (!boundary && length < 3 * h_)
        for (const std::uint32_t h : edges) clear(h);
    }
  }

  // Creases that end in a smooth place less than 2 h from where they start.
  void drop_stubs() {
    for (std::uint32_t v = 0; v < mesh_.position.size(); ++v) {
      if (mesh_.out[v] == kNone || is_locked(v) || feature_degree(v) != 1) continue;
      std::vector<std::uint32_t> path;
      Real length = 0;
      std::uint32_t at = v;
      while (length < 2 * h_) {
        std::uint32_t step = kNone;
        mesh_.for_out(at, [&](std::uint32_t h) {
          if (feature_[h] == kCrease && (path.empty() || h != mesh_.twin[path.back()])) step = h;
        });
        if (step == kNone) break;
        path.push_back(step);
        length += mesh_.edge_length(step);
        at = mesh_.to(step);
        if (feature_degree(at) != 2) break;
      }
      if (length < 2 * h_)
        for (const std::uint32_t h : path) clear(h);
    }
  }

  void trace_all() {
    for (std::uint32_t v = 0; v < mesh_.position.size(); ++v)
      if (result_.role[v] == VertexRole::kFixed)
        mesh_.for_out(v, [&](std::uint32_t h) {
          if (feature_[h] != kNoFeature && mesh_.line[h] == kNone) trace(h);
        });
    // What is left are closed loops without a fixed vertex.
    for (std::uint32_t h = 0; h < feature_.size(); ++h)
      if (feature_[h] != kNoFeature && mesh_.line[h] == kNone) trace(h);
  }

  // Follows the line that starts with half-edge h to the next fixed vertex, then cuts it at its sharp turns.
  void trace(std::uint32_t h) {
    std::vector<std::uint32_t> path{h};
    const std::uint32_t start = mesh_.from(h);
    while (mesh_.to(path.back()) != start && result_.role[mesh_.to(path.back())] != VertexRole::kFixed) {
      const std::uint32_t back = mesh_.twin[path.back()];
      std::uint32_t step = kNone;
      mesh_.for_out(mesh_.from(back), [&](std::uint32_t x) {
        if (feature_[x] != kNoFeature && x != back) step = x;
      });
      path.push_back(step);
    }
    const bool closed = mesh_.to(path.back()) == start;
    std::vector<std::size_t> cuts = sharp_turns(path);
    cuts.push_back(0), cuts.push_back(path.size());
    if (closed) add_thirds(path, cuts);
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) add_line(path, cuts[i], cuts[i + 1]);
  }

  std::vector<Real> arcs(const std::vector<std::uint32_t>& path) const {
    std::vector<Real> arc(path.size() + 1, 0);
    for (std::size_t i = 0; i < path.size(); ++i) arc[i + 1] = arc[i] + mesh_.edge_length(path[i]);
    return arc;
  }

  FeatureLine polyline(const std::vector<std::uint32_t>& path, std::size_t first, std::size_t last) const {
    FeatureLine line;
    line.point.push_back(mesh_.position[mesh_.from(path[first])]);
    line.arc.push_back(0);
    for (std::size_t i = first; i < last; ++i) {
      line.point.push_back(mesh_.position[mesh_.to(path[i])]);
      line.arc.push_back(line.arc.back() + mesh_.edge_length(path[i]));
    }
    return line;
  }

  // Interior vertices where the direction over a third of h on each side turns by more than the feature angle, only the
  // sharpest within that window: a jag much smaller than h is no corner.
  std::vector<std::size_t> sharp_turns(const std::vector<std::uint32_t>& path) const {
    const FeatureLine line = polyline(path, 0, path.size());
    const Real length = line.arc.back(), window = h_ / 3;
    std::vector<Real> cosine(path.size() + 1, 1);
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Real s = line.arc[i], w = std::min({window, s, length - s});
      cosine[i] = dot(normalized(line.point[i] - line.at(s - w)), normalized(line.at(s + w) - line.point[i]));
    }
    std::vector<std::size_t> cuts;
    for (std::size_t i = 1; i < path.size(); ++i) {
      if (cosine[i] >= cos_angle_) continue;
      bool sharpest = true;
      for (std::size_t j = i; j-- > 1 && line.arc[i] - line.arc[j] < window;) sharpest &= cosine[i] < cosine[j];
      for (std::size_t j = i + 1; j < path.size() && line.arc[j] - line.arc[i] < window; ++j)
        sharpest &= cosine[i] <= cosine[j];
      if (sharpest) cuts.push_back(i);
    }
    return cuts;
  }

  // A closed line needs three fixed vertices: it can then never degenerate, and arc lengths are unambiguous.
  void add_thirds(const std::vector<std::uint32_t>& path, std::vector<std::size_t>& cuts) const {
    if (cuts.size() >= 4) return;  // start, end and two turns
    const std::vector<Real> arc = arcs(path);
    for (int k = 1; k <= 2; ++k) {
      const Real target = arc.back() * k / 3;
      std::size_t best = std::min<std::size_t>(static_cast<std::size_t>(k), path.size() - 1);
      for (std::size_t i = 1; i < path.size(); ++i)
        if (std::abs(arc[i] - target) < std::abs(arc[best] - target)) best = i;
      cuts.push_back(best);
    }
  }

  void add_line(const std::vector<std::uint32_t>& path, std::size_t first, std::size_t last) {
    const auto id = static_cast<std::uint32_t>(result_.lines.size());
    result_.lines.push_back(polyline(path, first, last));
    for (std::size_t i = first; i < last; ++i) {
      mesh_.line[path[i]] = mesh_.line[mesh_.twin[path[i]]] = id;
      const std::uint32_t v = mesh_.to(path[i]);
      result_.role[v] = i + 1 == last ? VertexRole::kFixed : VertexRole::kLine;
      result_.line[v] = id;
      result_.arc[v] = result_.lines.back().arc[i + 1 - first];
    }
    result_.role[mesh_.from(path[first])] = VertexRole::kFixed;
  }

  EditMesh& mesh_;
  Real cos_angle_, h_;
  const std::vector<std::uint8_t>& locked_;
  std::vector<std::uint8_t> feature_;  // per half-edge
  FeatureLines result_;
};

}  // namespace

Vec3 FeatureLine::at(Real s) const {
  if (s <= 0) return point.front();
  if (s >= arc.back()) return point.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(arc.begin(), arc.end(), s) - arc.begin());
  const Real f = (s - arc[i - 1]) / (arc[i] - arc[i - 1]);
  return point[i - 1] + (point[i] - point[i - 1]) * f;
}

Real FeatureLine::nearest(const Vec3& p) const {
  Real best = 0, best_d = distance2(p, point.front());
  for (std::size_t i = 0; i + 1 < point.size(); ++i) {
    const Vec3 e = point[i + 1] - point[i];
    const Real l2 = norm2(e), f = l2 > 0 ? std::clamp(dot(p - point[i], e) / l2, 0.0, 1.0) : 0;
    const Real d = distance2(p, point[i] + e * f);
    if (d < best_d) best_d = d, best = arc[i] + f * (arc[i + 1] - arc[i]);
  }
  return best;
}

FeatureLines find_feature_lines(EditMesh& mesh, Real feature_angle_degrees, Real edge_length,
                                const std::vector<std::uint8_t>& locked) {
  return LineFinder(mesh, feature_angle_degrees, edge_length, locked).run();
}

}  // namespace sherd
