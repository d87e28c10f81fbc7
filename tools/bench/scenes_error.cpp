// Run time against error of whole scenes: every accuracy setting beside the finest. What a whole scene's error is, is
// four questions: when and where does the first crack start, into how many pieces of which volumes do the bodies fall,
// and how large were the stresses before?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "engine/scene/scene.h"
#include "kernels/core/vec3.h"
#include "tools/bench/plot.h"
#include "tools/bench/scenes.h"

namespace sherd::bench {
namespace {

using nlohmann::json;

struct Outcome {
  bool cracked = false;
  double first_time = 0;  // s
  Vec3 first_place;       // material space, m
  std::string first_body;
  double first_stress = 0;    // largest of the event, Pa
  std::size_t pieces = 0;     // bodies at the end that may break, or came of one that broke
  std::vector<double> share;  // of each of them of the volume of all of them, descending

  double loaded_until() const { return cracked ? first_time : std::numeric_limits<double>::infinity(); }
};

Vec3 vector_of(const json& j) {
  return {j[0], j[1], j[2]};
}

// Bodies that may not break are left out of the volumes: next to a table top all pieces are small.
std::set<std::string> unbreakable_bodies(const Scene& scene) {
  std::set<std::string> names;
  for (const SceneBody& b : scene.bodies)
    if (b.fixed || !b.breakable) names.insert(b.name);
  return names;
}

Outcome outcome_of(const json& stats, const std::set<std::string>& unbreakable) {
  Outcome o;
  for (const json& event : stats["events"]) {
    if (o.cracked || event["cracks"].empty() || !event.contains("solve")) continue;
    for (const json& crack : event["cracks"]) {
      if (crack["outcome"] != "complete" && crack["outcome"] != "arrested" && crack["outcome"] != "pierced") continue;
      o.cracked = true, o.first_time = event["time"], o.first_body = event["body"];
      o.first_place = vector_of(crack["seed"]), o.first_stress = event["solve"]["max_principal"];
      break;
    }
  }
  if (!stats["frames"].empty()) {
    double total = 0;
    for (const json& at : stats["frames"].back()["certificates"]) {
      const json& body = stats["certificates"][at.get<std::size_t>()];
      if (unbreakable.count(body["body"]) > 0) continue;
      o.share.push_back(body["volume"]);
      total += o.share.back();
    }
    for (double& v : o.share) v /= total;
  }
  std::sort(o.share.rbegin(), o.share.rend());
  o.pieces = o.share.size();
  return o;
}

// Half the sum of |difference| of the volumes in order of size: 0 equal, 1 nothing in common.
double volume_distance(const Outcome& a, const Outcome& b) {
  double sum = 0;
  for (std::size_t i = 0; i < std::max(a.pieces, b.pieces); ++i)
    sum += std::abs((i < a.pieces ? a.share[i] : 0) - (i < b.pieces ? b.share[i] : 0));
  return sum / 2;
}

// Of each body the largest stress of all events up to the one that cracks first; the rms of the differences over the
// rms of the reference. To each its own first crack: steps of different length see the same impact at different times.
double stress_distance(const json& a, double first_a, const json& b, double first_b) {
  const auto largest = [](const json& stats, double first) {
    std::map<std::string, double> of;
    for (const json& event : stats["events"]) {
      if (!event.contains("solve") || event["time"].get<double>() > first + 1e-9) continue;
      double& most = of[event["body"]];
      most = std::max(most, event["solve"]["max_principal"].get<double>());
    }
    return of;
  };
  std::map<std::string, double> x = largest(a, first_a), y = largest(b, first_b);
  double difference = 0, size = 0;
  for (const auto& [body, stress] : x) y.try_emplace(body, 0);
  for (const auto& [body, stress] : y) difference += (x[body] - stress) * (x[body] - stress), size += stress * stress;
  return size > 0 ? std::sqrt(difference / size) : 0;
}

double per_cent(double v) {
  return 100 * v;
}

void plot(const ScenesOptions& o, const std::string& scene, const json& rows) {
  LogLogPlot p{"Run time against error: " + scene,
               "CPU seconds",
               "difference from the finest run (%; 0.01 stands for none)",
               {}};
  for (const auto& [key, name] : {std::pair{"volume_error", "volumes of the pieces"},
                                  {"stress_error", "peak stress before the first crack"},
                                  {"pieces_error", "number of pieces"}}) {
    Series s{name, {}, {}, {}};
    for (const json& row : rows)
      if (row["scene"] == scene && row.contains(key)) {
        s.x.push_back(row["cpu_s"]), s.y.push_back(std::max(0.01, per_cent(row[key].get<double>())));
        s.label.push_back(row["quality"]);
      }
    p.series.push_back(std::move(s));
  }
  write_svg(p, o.plots + "/" + scene + ".svg");
}

// Settings differ in frames a second; runs to be compared end with a frame at one time, the first one that all have
// and that is not before frame `o.frames` at `default`. 0: all frames.
std::vector<int> frame_counts(const ScenesOptions& o, const std::string& scene,
                              const std::vector<std::string>& qualities) {
  const auto rate = [&](Quality q) { return load_scene(scene_file(o, scene), q).frame_rate; };
  std::vector<Real> rates;
  for (std::size_t q = 0; q < qualities.size(); ++q) rates.push_back(rate(static_cast<Quality>(q)));
  const Real slowest = *std::min_element(rates.begin(), rates.end());
  const Real spans = std::ceil((o.frames - 1) * slowest / rate(Quality::kDefault) - 1e-9);
  std::vector<int> counts;
  for (const Real r : rates)
    counts.push_back(o.frames > 0 ? static_cast<int>(std::lround(spans * r / slowest)) + 1 : 0);
  return counts;
}

}  // namespace

json scene_errors(const ScenesOptions& o, const std::vector<std::string>& scenes, bool& failed) {
  std::vector<std::string> qualities;  // in the order of Quality
  for (const std::string_view q : kQualityNames) {
    qualities.emplace_back(q);
    if (o.finest == q) break;
  }
  json rows = json::array();
  std::printf("\nRun time against error: each setting against %s.\n%-14s %-8s %9s %9s %8s %7s %10s %9s %8s %8s\n",
              o.finest.c_str(), "scene", "quality", "triangles", "CPU s", "pieces", "volume%", "first at s", "place mm",
              "stress%", "solves");
  for (const std::string& scene : scenes) {
    std::vector<SceneRun> runs;
    const std::vector<int> frames = frame_counts(o, scene, qualities);
    for (std::size_t q = 0; q < qualities.size(); ++q) {
      ScenesOptions one = o;
      one.frames = frames[q];
      runs.push_back(run_scene(one, scene, qualities[q], o.threads.back()));
    }
    if (std::any_of(runs.begin(), runs.end(), [](const SceneRun& r) { return r.exit_code != 0; })) {
      failed = true;
      std::printf("%-14s a run failed\n", scene.c_str());
      continue;
    }
    const std::set<std::string> unbreakable = unbreakable_bodies(load_scene(scene_file(o, scene)));
    const Outcome finest = outcome_of(runs.back().stats, unbreakable);
    for (const SceneRun& run : runs) {
      const Outcome at = outcome_of(run.stats, unbreakable);
      const SceneNumbers n = scene_numbers(run.stats);
      const bool both = at.cracked && finest.cracked;
      const double place = both ? distance(at.first_place, finest.first_place) : 0;
      json row{{"scene", scene},     {"quality", run.quality}, {"triangles", n.triangles}, {"solves", n.solves},
               {"cpu_s", run.cpu_s}, {"wall_s", run.wall_s},   {"pieces", at.pieces},      {"volumes", at.share}};
      if (at.cracked)
        row["first_crack"] = {{"body", at.first_body}, {"time", at.first_time}, {"stress", at.first_stress}};
      const double volume = volume_distance(at, finest),
                   stress = stress_distance(run.stats, at.loaded_until(), runs.back().stats, finest.loaded_until());
      if (&run != &runs.back()) {
        row["volume_error"] = volume, row["stress_error"] = stress;
        if (both) {
          row["time_error_s"] = std::abs(at.first_time - finest.first_time);
          row["place_distance"] = place;
          row["same_body"] = at.first_body == finest.first_body;
        }
        row["pieces_error"] = std::abs(static_cast<double>(at.pieces) - static_cast<double>(finest.pieces)) /
                              static_cast<double>(std::max<std::size_t>(1, finest.pieces));
      }
      std::printf("%-14s %-8s %9zu %9.1f %8zu %7.2f %10s %9s %8.2f %8zu\n", scene.c_str(), run.quality.c_str(),
                  n.triangles, run.cpu_s, at.pieces, per_cent(volume),
                  at.cracked ? fmt::format("{:.4f}", at.first_time).c_str() : "none",
                  !both                                ? "-"
                  : at.first_body == finest.first_body ? fmt::format("{:.1f}", 1000 * place).c_str()
                                                       : "other body",
                  per_cent(stress), n.solves);
      std::fflush(stdout);
      rows.push_back(std::move(row));
    }
    if (!o.plots.empty()) plot(o, scene, rows);
  }
  return rows;
}

}  // namespace sherd::bench
