#include "engine/fracture/grow.h"

#include <algorithm>

#include "engine/fracture/attempt.h"
#include "engine/fracture/seed.h"

namespace sherd {
namespace {

// start(Growth&) lays the first sheet and returns the reason of a refusal.
template <class Start>
GrowthResult climb_ladder(const TriangleBvh& body, const CrackField& field, const GrowthOptions& options,
                          const Start& start) {
  GrowthResult result;
  result.reason = check_options(body, options);
  if (!result.reason.empty()) return result;
  Rungs rungs;
  std::size_t asked = 0, spared = 0;
  for (int level = 0; level < std::min(options.rungs, kRungCount); ++level) {
    std::string& reason = rungs.reason[static_cast<std::size_t>(level)];
    Attempt attempt(body, field, options, level);
    reason = start(attempt.growth());
    if (!reason.empty()) {
      if (level > 0) continue;
      result.outcome = GrowthOutcome::kRejectedSeed;
      break;
    }
    do {
      while (attempt.step()) {
      }
      result = attempt.finish();
    } while (result.outcome == GrowthOutcome::kFailed && attempt.retreat());
    reason = result.reason;
    asked += attempt.growth().stresses_asked, spared += attempt.growth().stresses_spared;
    if (result.outcome != GrowthOutcome::kFailed) break;
  }
  result.reason = rungs.reason[0];
  result.rungs = std::move(rungs);
  result.stresses_asked = asked, result.stresses_spared = spared;
  return result;
}

}  // namespace

GrowthResult grow_crack(const TriangleBvh& body, const CrackField& field, const CrackSeed& seed,
                        const GrowthOptions& options) {
  return climb_ladder(body, field, options, [&](Growth& g) { return open_seed(g, seed); });
}

GrowthResult resume_crack(const TriangleBvh& body, const CrackField& field, const CrackSheet& shown,
                          const GrowthOptions& options) {
  const CrackSheet& sheet = shown.stopped ? *shown.stopped : shown;
  const std::string bad = check_sheet(sheet);
  return climb_ladder(body, field, options, [&](Growth& g) { return bad.empty() ? open_sheet(g, sheet) : bad; });
}

}  // namespace sherd
