#include "engine/mesh/resample.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/mesh/attributes.h"

namespace sherd {
namespace {

constexpr float kJump = 1e-5F;  // of a channel's range: more than rounding in single precision, less than any seam

// Largest difference between neighbours' values that is rounding, per channel.
std::vector<float> jump_limits(const SurfaceMesh& mesh) {
  std::vector<float> limits;
  for (const CornerChannel& c : mesh.channels) {
    const auto [low, high] = std::minmax_element(c.value.begin(), c.value.end());
    limits.push_back(c.value.empty() ? 0 : kJump * (*high - *low));
  }
  return limits;
}

// Values on both sides of half-edge e agree at both its ends.
bool continuous(const SurfaceMesh& mesh, const std::vector<float>& limits, std::uint32_t e, std::uint32_t twin) {
  const auto next = [](std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; };
  for (std::size_t c = 0; c < mesh.channels.size(); ++c) {
    const auto n = static_cast<std::size_t>(mesh.channels[c].components);
    const float* v = mesh.channels[c].value.data();
    for (const auto& [a, b] : {std::pair{e, next(twin)}, std::pair{next(e), twin}})
      for (std::size_t i = 0; i < n; ++i)
        if (!(std::abs(v[n * a + i] - v[n * b + i]) <= limits[c])) return false;
  }
  return true;
}

auto columns_of(const SurfaceMesh& mesh, std::size_t t) {
  return std::tuple(mesh.faces.kind[t], mesh.faces.crack[t], mesh.faces.material[t]);
}

}  // namespace

std::vector<std::uint32_t> label_charts(const SurfaceMesh& mesh) {
  if (mesh.channels.empty()) return {};
  const std::vector<std::uint32_t> twin = build_twins(mesh);
  const std::vector<float> limits = jump_limits(mesh);
  std::vector<std::uint32_t> chart(mesh.triangle_count(), kNone), stack;
  std::uint32_t count = 0;
  for (std::uint32_t seed = 0; seed < chart.size(); ++seed) {
    if (chart[seed] != kNone) continue;
    stack.assign(1, seed), chart[seed] = count;
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::uint32_t e = 3 * t; e < 3 * t + 3; ++e) {
        if (twin[e] == kNone || chart[twin[e] / 3] != kNone || columns_of(mesh, t) != columns_of(mesh, twin[e] / 3) ||
            !continuous(mesh, limits, e, twin[e]))
          continue;
        chart[twin[e] / 3] = count;
        stack.push_back(twin[e] / 3);
      }
    }
    ++count;
  }
  return chart;
}

std::vector<std::uint32_t> label_regions(const SurfaceMesh& mesh, bool seams, Real least_chart) {
  const std::size_t n = mesh.triangle_count();
  std::vector<std::uint32_t> chart = seams ? label_charts(mesh) : std::vector<std::uint32_t>{};
  if (chart.empty()) chart.assign(n, kNone);
  std::vector<Real> area;
  for (std::size_t t = 0; t < n; ++t) {
    if (chart[t] == kNone) continue;
    if (chart[t] >= area.size()) area.resize(chart[t] + 1, 0);
    area[chart[t]] += 0.5 * norm(mesh.area_normal2(t));
  }
  const auto key = [&](std::size_t t) {
    const bool kept = chart[t] != kNone && area[chart[t]] > least_chart;
    return std::tuple_cat(columns_of(mesh, t), std::tuple(kept ? chart[t] : kNone));
  };
  std::vector<decltype(key(0))> keys;
  for (std::size_t t = 0; t < n; ++t)
    if (t == 0 || key(t) != key(t - 1)) keys.push_back(key(t));
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<std::uint32_t> region(n);
  for (std::size_t t = 0; t < n; ++t)
    region[t] = t > 0 && key(t) == key(t - 1)
                    ? region[t - 1]
                    : static_cast<std::uint32_t>(std::lower_bound(keys.begin(), keys.end(), key(t)) - keys.begin());
  return region;
}

ChannelSampler::ChannelSampler(const SurfaceMesh& from, const TriangleBvh& bvh)
    : from_(from), bvh_(bvh), chart_(label_charts(from)) {}

void ChannelSampler::append(std::uint32_t face, const std::array<Vec3, 3>& at, SurfaceMesh& to) const {
  if (from_.channels.empty()) return;
  std::vector<std::uint32_t> near;
  for (const Vec3& p : at) {
    const auto on_face = [&](std::uint32_t f) {
      const auto& c = bvh_.corners(f);
      const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
      return TriangleBvh::Closest{q, f, distance2(p, q)};
    };
    TriangleBvh::Closest best = on_face(face);
    if (best.distance2 > 0) {
      const TriangleBvh::Closest any = bvh_.closest(p);
      if (any.face != kNone && chart_[any.face] == chart_[face]) {
        best = any;
      } else {
        const Real reach = std::sqrt(best.distance2);
        bvh_.overlapping({p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}}, near);
        for (const std::uint32_t f : near) {
          if (chart_[f] != chart_[face]) continue;
          if (const auto found = on_face(f); found.distance2 < best.distance2) best = found;
        }
      }
    }
    append_corner(from_, best.face, best.point, to);
  }
}

void resample_channels(const SurfaceMesh& from, SurfaceMesh& to) {
  to.channels.clear();
  if (from.channels.empty()) return;
  const TriangleBvh bvh(from);
  const ChannelSampler sampler(from, bvh);
  SurfaceMesh sampled;
  match_channels(from, sampled);
  for (std::size_t t = 0; t < to.triangle_count(); ++t)
    sampler.append(bvh.closest(to.centroid(t)).face, {to.corner(t, 0), to.corner(t, 1), to.corner(t, 2)}, sampled);
  to.channels = std::move(sampled.channels);
}

}  // namespace sherd
