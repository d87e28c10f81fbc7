// Triangles without a usable altitude: a cap (the third vertex near the longest edge) is flipped away, a needle (two
// vertices near each other) is collapsed.
#include <algorithm>
#include <numeric>

#include "engine/mesh/attributes.h"
#include "engine/mesh/repair_steps.h"
#include "engine/mesh/validate_edges.h"

namespace sherd {
namespace {

class NeedleRemover {
 public:
  explicit NeedleRemover(SurfaceMesh& mesh) : mesh_(mesh) {}

  // One pass over all needles, each operation on triangles no other operation of the pass touched. False: nothing done.
  bool pass(NeedleRemoval& done) {
    twin_ = build_twins(mesh_);
    fill_rings();
    locked_.assign(mesh_.vertex_count(), false);
    dead_.assign(mesh_.triangle_count(), false);
    const NeedleRemoval before = done;
    for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t) {
      if (dead_[t] || touches_locked(t) || shape(mesh_.triangles[t]) >= kNeedleShape) continue;
      if (flip(t))
        ++done.flips;
      else if (collapse(t))
        ++done.collapses;
    }
    remove_dead();
    return done.flips + done.collapses > before.flips + before.collapses;
  }

 private:
  Vec3 at(std::uint32_t v) const { return mesh_.vertices[v]; }
  Real shape(const Triangle& f) const { return triangle_shape(at(f[0]), at(f[1]), at(f[2])); }
  bool touches_locked(std::uint32_t t) const {
    const Triangle& f = mesh_.triangles[t];
    return locked_[f[0]] || locked_[f[1]] || locked_[f[2]];
  }
  void fill_rings() {
    first_.assign(mesh_.vertex_count() + 1, 0);
    for (const Triangle& f : mesh_.triangles)
      for (const std::uint32_t v : f) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    ring_.resize(3 * mesh_.triangle_count());
    for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t)
      for (const std::uint32_t v : mesh_.triangles[t]) ring_[next[v]++] = t;
  }
  std::vector<std::uint32_t> neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i)
      for (const std::uint32_t w : mesh_.triangles[ring_[i]])
        if (w != v) out.push_back(w);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }
  bool ring_is_free(std::uint32_t v) const {
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i)
      if (touches_locked(ring_[i])) return false;
    return true;
  }
  void lock_ring(std::uint32_t v) {
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i)
      for (const std::uint32_t w : mesh_.triangles[ring_[i]]) locked_[w] = true;
  }

  // Replaces the longest edge ab of abc by cd, d the far vertex of the triangle beyond ab.
  bool flip(std::uint32_t t) {
    std::uint32_t k = 0;
    const auto length2 = [&](std::uint32_t i) {
      return distance2(mesh_.corner(t, static_cast<int>(i)), mesh_.corner(t, static_cast<int>((i + 1) % 3)));
    };
    for (std::uint32_t i = 1; i < 3; ++i)
      if (length2(i) > length2(k)) k = i;
    const std::uint32_t e = twin_[3 * t + k];
    if (e == kNone) return false;
    const std::uint32_t other = e / 3;
    const std::uint32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3],
                        c = mesh_.triangles[t][(k + 2) % 3];
    const std::uint32_t d = mesh_.triangles[other][(e % 3 + 2) % 3];
    if (c == d || locked_[d]) return false;
    const std::vector<std::uint32_t> around = neighbours(c);
    if (std::binary_search(around.begin(), around.end(), d)) return false;
    const Triangle p{a, d, c}, q{d, b, c};
    const Real old_shape = std::min(shape(mesh_.triangles[t]), shape(mesh_.triangles[other]));
    if (std::min(shape(p), shape(q)) <= std::max(2 * old_shape, kDegenerateShape)) return false;
    // Both new triangles look the way the healthy old one did: no fold.
    const Vec3 n = mesh_.area_normal2(other);
    const auto normal = [&](const Triangle& f) { return cross(at(f[1]) - at(f[0]), at(f[2]) - at(f[0])); };
    if (dot(normal(p), n) < 0 || dot(normal(q), n) < 0) return false;
    mesh_.triangles[t] = p, mesh_.triangles[other] = q;
    for (const std::uint32_t v : {a, b, c, d}) locked_[v] = true;
    return true;
  }

  // Merges the nearer two vertices when the surface stays a surface and no triangle around turns over.
  bool collapse(std::uint32_t t) {
    std::uint32_t k = 0;
    Real shortest = std::numeric_limits<Real>::infinity(), longest = 0;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const Real l = distance(mesh_.corner(t, static_cast<int>(i)), mesh_.corner(t, static_cast<int>((i + 1) % 3)));
      if (l < shortest) shortest = l, k = i;
      longest = std::max(longest, l);
    }
    if (shortest > 0.05 * longest) return false;
    const std::uint32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3];
    return try_collapse(a, b) || try_collapse(b, a);
  }
  bool try_collapse(std::uint32_t keep, std::uint32_t gone) {
    if (!ring_is_free(keep) || !ring_is_free(gone)) return false;
    const std::vector<std::uint32_t> a = neighbours(keep), b = neighbours(gone);
    std::vector<std::uint32_t> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    if (common.size() != 2 || a.size() + b.size() < 8) return false;  // link condition; a tetrahedron must stay one
    for (std::uint32_t i = first_[gone]; i < first_[gone + 1]; ++i) {
      const Triangle& f = mesh_.triangles[ring_[i]];
      if (std::find(f.begin(), f.end(), keep) != f.end()) continue;
      Triangle moved = f;
      std::replace(moved.begin(), moved.end(), gone, keep);
      const Vec3 n = cross(at(moved[1]) - at(moved[0]), at(moved[2]) - at(moved[0]));
      if (shape(f) >= kNeedleShape && (shape(moved) < kNeedleShape || dot(n, mesh_.area_normal2(ring_[i])) <= 0))
        return false;
    }
    lock_ring(keep), lock_ring(gone);
    for (std::uint32_t i = first_[gone]; i < first_[gone + 1]; ++i) {
      Triangle& f = mesh_.triangles[ring_[i]];
      if (std::find(f.begin(), f.end(), keep) != f.end()) dead_[ring_[i]] = true;
      std::replace(f.begin(), f.end(), gone, keep);
    }
    return true;
  }
  void remove_dead() {
    dead_.flip();
    keep_faces(mesh_, dead_);
  }

  SurfaceMesh& mesh_;
  std::vector<std::uint32_t> twin_, first_, ring_;  // ring_[first_[v] .. first_[v + 1]): triangles around v
  std::vector<bool> locked_, dead_;
};

}  // namespace

NeedleRemoval remove_needles(SurfaceMesh& mesh) {
  NeedleRemoval done;
  const auto has_needles = [&] {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      if (triangle_shape(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)) < kNeedleShape) return true;
    return false;
  };
  constexpr int kMaxPasses = 50;  // rows of collinear vertices need one pass each
  for (int i = 0; i < kMaxPasses && has_needles(); ++i)
    if (!NeedleRemover(mesh).pass(done)) break;
  if (done.collapses > 0) drop_unused_vertices(mesh);
  return done;
}

}  // namespace sherd
