// How long a crack takes, and whether its cost depends on the body's size.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/fracture/thicken.h"
#include "engine/mesh/shapes.h"
#include "kernels/core/parallel.h"
#include "tools/bench/cracks.h"
#include "tools/campaign/cpu_clock.h"

namespace sherd::bench {
namespace {

using namespace campaign;

double cpu_ms() {
  return 1e3 * cpu_seconds();
}

template <class F>
double median_ms(int repeats, const F& work) {
  std::vector<double> ms;
  for (int i = 0; i < repeats; ++i) {
    const double start = cpu_ms();
    work();
    ms.push_back(cpu_ms() - start);
  }
  std::nth_element(ms.begin(), ms.begin() + repeats / 2, ms.end());
  return ms[static_cast<std::size_t>(repeats / 2)];
}

// A flat disk of `rings` rings in the plane z = height; its border lies outside of the body.
CrackSheet disk(Real radius, Real height, int rings) {
  CrackSheet s;
  const auto add = [&](Real r, Real angle, bool border) {
    // The turn keeps the nodes off the mesh's planes of symmetry.
    s.position.push_back({r * std::cos(angle + 0.1), r * std::sin(angle + 0.1), height});
    s.normal.push_back({0, 0, 1});
    s.state.push_back(border ? NodeState::kExited : NodeState::kInterior);
  };
  add(0, 0, false);
  std::uint32_t inner = 0;  // first node of the ring inside
  for (int k = 1; k <= rings; ++k) {
    const auto n = static_cast<std::uint32_t>(6 * k), before = static_cast<std::uint32_t>(std::max(1, 6 * (k - 1)));
    const auto outer = static_cast<std::uint32_t>(s.position.size());
    for (std::uint32_t i = 0; i < n; ++i) add(radius * k / rings, 2 * M_PI * i / n, k == rings);
    for (std::uint32_t i = 0; i < n; ++i) {
      // Six sectors of k edges outside and k - 1 inside.
      const std::uint32_t sector = i / static_cast<std::uint32_t>(k), step = i % static_cast<std::uint32_t>(k);
      const std::uint32_t a = inner + (k == 1 ? 0 : (sector * static_cast<std::uint32_t>(k - 1) + step) % before);
      s.triangles.push_back({a, outer + i, outer + (i + 1) % n});
      if (step + 1 < static_cast<std::uint32_t>(k)) {
        const std::uint32_t b = inner + (sector * static_cast<std::uint32_t>(k - 1) + step + 1) % before;
        s.triangles.push_back({a, outer + (i + 1) % n, b});
      }
    }
    inner = outer;
  }
  return s;
}

// The same crack in spheres of growing size, all with edges near 1 m: a cap of the given radius is cut off.
void time_sizes(const char* name, Real cap_radius, nlohmann::json& rows) {
  std::printf("\n%s: the same cap of radius %.1f edges off spheres\n%8s %8s %9s %9s %8s\n", name, cap_radius, "faces",
              "touched", "body ms", "cut ms", "ratio");
  double before = 0;
  for (const int frequency : {14, 28, 55, 110}) {
    const Real radius = 0.92 * frequency;  // edges about 1.1 radius / frequency on average
    const SurfaceMesh mesh = make_sphere(radius, 1.05 * radius / frequency);
    const Real height = std::sqrt(radius * radius - cap_radius * cap_radius);
    std::string reason;
    const auto slab =
        thicken(disk(cap_radius + 0.3, height, std::max(2, static_cast<int>(cap_radius))), 0.01, 1, reason);
    if (!slab) {
      std::printf("%8zu no slab: %s\n", mesh.triangle_count(), reason.c_str());
      continue;
    }
    CutOptions o;
    o.edge_length = 1, o.slab_checked = true, o.min_fragment_volume = 0;
    const double start = cpu_ms();
    const CutBody body(mesh);
    const double prepare = cpu_ms() - start;
    CutResult result;
    const double ms = median_ms(7, [&] { result = cut(body, *slab, o); });
    std::printf("%8zu %8zu %9.1f %9.2f %8s%s\n", mesh.triangle_count(), result.touched, prepare, ms,
                before > 0 ? std::to_string(ms / before).substr(0, 5).c_str() : "",
                result.ok ? "" : result.reason.c_str());
    rows.push_back({{"crack", name},
                    {"faces", mesh.triangle_count()},
                    {"touched", result.touched},
                    {"body_ms", prepare},
                    {"cut_ms", ms},
                    {"fragments", result.fragments.size()}});
    before = ms;
  }
}

// A crack of about 500 sheet triangles straight through a body of about 20,000 faces.
void time_crack(nlohmann::json& rows) {
  const Specimen bar("bar", make_bar(200, 12, 12, 1));
  std::printf("\nGrowth and cut in a bar of %zu faces, one thread\n%-10s %9s %9s %9s %9s %9s\n",
              bar.mesh().triangle_count(), "field", "triangles", "grow ms", "cut ms", "sum ms", "points");
  const Vec3 e{1, 0.05, 0.03};
  for (const bool noise : {false, true}) {
    const FunctionField field(noise ? noisy_direction(e, 0.2, 8 * bar.h, 3) : constant_direction(e));
    const CrackSeed seed = bar.seed_at(bar.nearest_vertex({0.3, 6, 1.2}), field);
    std::vector<double> grow, sum;
    Crack crack;
    for (int i = 0; i < 7; ++i) {
      crack = run_crack(bar, field, seed, bar.options());
      grow.push_back(1e3 * crack.report.grow_s), sum.push_back(1e3 * (crack.report.grow_s + crack.report.cut_s));
    }
    std::sort(grow.begin(), grow.end()), std::sort(sum.begin(), sum.end());
    const double g = grow[3], s = sum[3];
    std::printf("%-10s %9zu %9.1f %9.1f %9.1f %9zu  %s\n", noise ? "noise" : "constant", crack.report.sheet_triangles,
                g, s - g, s, crack.report.stress_points, to_string(crack.report.outcome));
    rows.push_back({{"crack", noise ? "bar, noise" : "bar, constant"},
                    {"faces", bar.mesh().triangle_count()},
                    {"sheet_triangles", crack.report.sheet_triangles},
                    {"grow_ms", g},
                    {"cut_ms", s - g},
                    {"sum_ms", s}});
  }
}

}  // namespace

int run_crack_timing(const std::string& json) {
  const ThreadLimit limit(1);
  nlohmann::json rows = nlohmann::json::array();
  std::printf("CPU time of one thread, medians of 7\n");
  time_crack(rows);
  time_sizes("chip", 2.7, rows);
  time_sizes("crack", 8, rows);
  if (!json.empty()) std::ofstream(json) << nlohmann::json{{"timing", rows}}.dump(1) << "\n";
  return 0;
}

}  // namespace sherd::bench
