#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "tools/campaign/campaign.h"

namespace sherd::campaign {
namespace {

std::string hex(std::uint64_t v) {
  return fmt::format("{:016x}", v);
}

nlohmann::json to_json(const Fidelity& f) {
  return {{"cracks", f.cracks}, {"mean_angle_deg", f.mean_degrees()}};
}

nlohmann::json to_json(const Tally& t) {
  return {{"shape", t.shape},
          {"field", t.field},
          {"faces", t.faces},
          {"jobs", t.jobs},
          {"separated", t.separated},
          {"pierced", t.pierced},
          {"arrested", t.arrested},
          {"dropped", t.dropped},
          {"rejected_seeds", t.rejected},
          {"levels", t.level},
          {"true_field_share", t.true_field_share()},
          {"straight_share", t.straight_share()},
          {"straight", to_json(t.straight)},
          {"retreated", to_json(t.retreated)},
          {"ladder", to_json(t.ladder)},
          {"dropped_share", t.dropped_share()},
          {"invalid", t.invalid},
          {"bodies_changed", t.body_changed},
          {"hangs", t.hangs},
          {"sheet_triangles", t.sheet_triangles},
          {"stress_points", t.stress_points},
          {"jitters", t.jitters},
          {"grow_s", t.grow_s},
          {"cut_s", t.cut_s},
          {"longest_s", t.max_s},
          {"worst_balance", t.worst_balance},
          {"hash", hex(t.hash)}};
}

nlohmann::json to_json(const JobResult& j) {
  const CrackReport& r = j.report;
  nlohmann::json out{{"index", j.index},
                     {"field", to_string(j.field)},
                     {"vertex", j.vertex},
                     {"rejected_seeds", j.rejected},
                     {"arrest", j.arrest},
                     {"outcome", to_string(r.outcome)},
                     {"level", r.level},
                     {"retreats", r.retreats},
                     {"wings", r.wings},
                     {"wings_through", r.wings_through},
                     {"angle_deg", r.angle * 180 / std::numbers::pi},
                     {"steps", r.steps},
                     {"sheet_triangles", r.sheet_triangles},
                     {"stress_points", r.stress_points},
                     {"fragments", r.fragments},
                     {"area", r.area},
                     {"removed_volume", r.removed_volume},
                     {"balance", r.balance},
                     {"jitters", r.jitters},
                     {"grow_s", r.grow_s},
                     {"cut_s", r.cut_s},
                     {"hash", hex(r.hash)}};
  for (const std::string& text : r.rungs.reason)
    if (!text.empty()) out["rungs"].push_back(text);
  if (!r.reason.empty()) out["reason"] = r.reason;
  if (!r.invalid.empty()) out["invalid"] = r.invalid;
  if (r.body_changed) out["body_changed"] = true;
  return out;
}

}  // namespace

std::string table_header() {
  return fmt::format(
      "{:<12} {:<9} {:>6} {:>5} {:>5} {:>5} {:>5} {:>7} {:>7} {:>13} {:>14} {:>5} {:>7} {:>7} {:>4} {:>5} {:>6} {:>7} "
      "{:>7} {:>8}",
      "shape", "field", "faces", "jobs", "sep.", "pier.", "arr.", "level 0", "at once", "levels 1-4", "degrees off",
      "drop", "drop %", "invalid", "chg", "hang", "tri", "grow ms", "cut ms", "worst ms");
}

std::string table_row(const Tally& t) {
  const Real n = t.jobs ? static_cast<Real>(t.jobs) : 1;
  const std::string levels = fmt::format("{}/{}/{}/{}", t.level[1], t.level[2], t.level[3], t.level[4]);
  const auto degrees = [](const Fidelity& f) { return f.cracks ? fmt::format("{:.1f}", f.mean_degrees()) : "-"; };
  const std::string off = degrees(t.straight) + "/" + degrees(t.retreated) + "/" + degrees(t.ladder);
  return fmt::format(
      "{:<12} {:<9} {:>6} {:>5} {:>5} {:>5} {:>5} {:>6.1f}% {:>6.1f}% {:>13} {:>14} {:>5} {:>6.2f}% {:>7} {:>4} {:>5} "
      "{:>6.0f} {:>7.1f} {:>7.1f} {:>8.0f}",
      t.shape, t.field, t.faces, t.jobs, t.separated, t.pierced, t.arrested, 100 * t.true_field_share(),
      100 * t.straight_share(), levels, off, t.dropped, 100 * t.dropped_share(), t.invalid, t.body_changed, t.hangs,
      static_cast<Real>(t.sheet_triangles) / n, 1e3 * t.grow_s / n, 1e3 * t.cut_s / n, 1e3 * t.max_s);
}

nlohmann::json to_json(const ShapeResult& result) {
  nlohmann::json jobs = nlohmann::json::array(), fields = nlohmann::json::array();
  for (const JobResult& j : result.jobs) jobs.push_back(to_json(j));
  for (const Tally& t : result.fields) fields.push_back(to_json(t));
  return {{"total", to_json(result.all)}, {"fields", fields}, {"jobs", jobs}};
}

}  // namespace sherd::campaign
