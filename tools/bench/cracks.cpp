#include "tools/bench/cracks.h"

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/mesh/write.h"
#include "tools/campaign/generations.h"

namespace sherd::bench {
namespace {

using namespace campaign;

void print_troubled(const ShapeResult& result) {
  for (const JobResult& j : result.jobs) {
    const CrackReport& r = j.report;
    if (r.outcome == CrackOutcome::kRejected ||
        (r.level == 0 && r.outcome != CrackOutcome::kDropped && r.invalid.empty()))
      continue;
    std::printf("  %-9s job %4zu %-9s level %d  %s%s%s\n", to_string(j.field), j.index, to_string(r.outcome), r.level,
                r.reason.c_str(), r.invalid.empty() ? "" : "  INVALID: ", r.invalid.c_str());
  }
}

int run_generation_study(const CracksOptions& o) {
  nlohmann::json shapes = nlohmann::json::array();
  std::printf("%s\n", generation_header().c_str());
  int status = 0;
  for (const std::string& name : o.shapes.empty() ? specimen_names() : o.shapes) {
    const auto specimen = make_specimen(name, o.meshes);
    if (!specimen) continue;
    GenerationOptions options;
    options.seed = o.campaign.seed, options.thickness = o.campaign.thickness;
    options.edge_per_thickness = o.edge_per_thickness;
    const GenerationResult result = run_generations(*specimen, options);
    std::printf("%s", to_text(result).c_str());
    for (const std::string& text : result.warnings) std::printf("  %s\n", text.c_str());
    std::fflush(stdout);
    for (const GenerationRow& row : result.rows)
      if (row.invalid || row.certified < row.pieces) status = 1;
    if (!o.pieces.empty())
      for (std::size_t i = 0; i < result.pieces.size(); ++i)
        write_ply(result.pieces[i], o.pieces + "/" + name + "_" + std::to_string(i) + ".ply", PlyPrecision::kDouble);
    shapes.push_back(to_json(result));
  }
  if (!o.json.empty()) std::ofstream(o.json) << nlohmann::json{{"generations", shapes}}.dump(1) << "\n";
  return status;
}

}  // namespace

int run_cracks(const CracksOptions& o) {
  if (o.timing) return run_crack_timing(o.json);
  if (o.generations) return run_generation_study(o);
  nlohmann::json shapes = nlohmann::json::array();
  std::printf("%s\n", table_header().c_str());
  int status = 0;
  for (const std::string& name : o.shapes.empty() ? specimen_names() : o.shapes) {
    const auto specimen = make_specimen(name, o.meshes);
    if (!specimen) {
      std::printf("%-12s skipped: its file is not in %s (--meshes)\n", name.c_str(), o.meshes.c_str());
      continue;
    }
    const ShapeResult result = run_shape(*specimen, o.campaign);
    for (const Tally& t : result.fields) std::printf("%s\n", table_row(t).c_str());
    std::printf("%s\n", table_row(result.all).c_str());
    if (o.log) print_troubled(result);
    std::fflush(stdout);
    if (result.all.invalid || result.all.body_changed || result.all.hangs) status = 1;
    shapes.push_back(to_json(result));
  }
  if (!o.json.empty()) std::ofstream(o.json) << nlohmann::json{{"cracks", shapes}}.dump(1) << "\n";
  return status;
}

}  // namespace sherd::bench
