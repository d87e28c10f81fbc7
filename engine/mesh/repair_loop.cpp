#include "engine/mesh/repair_loop.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/mesh/validate_edges.h"

namespace sherd {
namespace {

constexpr std::size_t kLongestExact = 400;

// Area, plus a little for bad shape: it decides between the equal areas of a planar loop (and keeps triangles between
// collinear vertices out), and is too small to pay for an overlap.
Real cost(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Real longest2 = std::max({distance2(a, b), distance2(b, c), distance2(c, a)});
  return 0.5 * norm(cross(b - a, c - a)) + 1e-6 * (1 - triangle_shape(a, b, c)) * longest2;
}

void exact(const std::vector<Vec3>& loop, const std::vector<std::uint32_t>& ids, std::vector<Triangle>& out) {
  const std::size_t n = ids.size();
  std::vector<Real> best(n * n, 0.0);
  std::vector<std::uint32_t> apex(n * n, kNone);
  for (std::size_t span = 2; span < n; ++span)
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      Real least = std::numeric_limits<Real>::infinity();
      for (std::size_t k = i + 1; k < j; ++k) {
        const Real c = best[i * n + k] + best[k * n + j] + cost(loop[ids[i]], loop[ids[k]], loop[ids[j]]);
        if (c < least || apex[i * n + j] == kNone) least = c, apex[i * n + j] = static_cast<std::uint32_t>(k);
      }
      best[i * n + j] = least;
    }
  std::vector<std::pair<std::size_t, std::size_t>> stack{{0, n - 1}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = apex[i * n + j];
    out.push_back({ids[i], ids[k], ids[j]});
    stack.push_back({i, k}), stack.push_back({k, j});
  }
}

// Newell's area vector: the loop's mean normal.
Vec3 loop_normal(const std::vector<Vec3>& loop) {
  Vec3 n;
  for (std::size_t i = 0; i < loop.size(); ++i) n += cross(loop[i] - loop[0], loop[(i + 1) % loop.size()] - loop[0]);
  return normalized(n);
}

}  // namespace

std::vector<Triangle> triangulate_loop(const std::vector<Vec3>& loop) {
  std::vector<Triangle> out;
  if (loop.size() < 3) return out;
  std::vector<std::uint32_t> ids(loop.size());
  std::iota(ids.begin(), ids.end(), 0u);
  const Vec3 normal = loop_normal(loop);
  while (ids.size() > kLongestExact) {
    std::size_t ear = 0;
    Real best = -std::numeric_limits<Real>::infinity();
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const Vec3 a = loop[ids[(i + ids.size() - 1) % ids.size()]], b = loop[ids[i]],
                 c = loop[ids[(i + 1) % ids.size()]];
      const bool convex = dot(cross(b - a, c - a), normal) > 0;
      const Real score = convex ? triangle_shape(a, b, c) / distance(a, c) : -distance(a, c);
      if (score > best) best = score, ear = i;
    }
    out.push_back({ids[(ear + ids.size() - 1) % ids.size()], ids[ear], ids[(ear + 1) % ids.size()]});
    ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  exact(loop, ids, out);
  return out;
}

}  // namespace sherd
