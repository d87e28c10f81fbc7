#include "engine/fracture/check_growth.h"

#include <fmt/format.h>

#include "engine/fracture/thicken.h"

namespace sherd {
namespace {

std::string check_border(const GrowthResult& r, const TriangleBvh& body) {
  const CrackSheet& s = r.sheet;
  std::vector<TriangleBvh::Hit> hits;
  bool complete = true, stopped = !r.met.empty();
  for (const std::vector<std::uint32_t>& loop : border_loops(s))
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      const bool exited = s.state[a] == NodeState::kExited;
      if (s.state[a] == NodeState::kInterior) return fmt::format("border node {} counts as interior", a);
      if (s.state[a] == NodeState::kActive) return fmt::format("border node {} would grow on", a);
      if (exited && body.inside(s.position[a])) return fmt::format("exited node {} lies inside the body", a);
      stopped |= s.state[a] == NodeState::kArrested;
      body.all_hits(s.position[a], s.position[b] - s.position[a], 0, 1, hits);
      complete &= exited && s.state[b] == NodeState::kExited && hits.empty();
    }
  if (complete != (r.outcome == GrowthOutcome::kComplete)) return "completeness is not what the border shows";
  if (!complete && !stopped) return "arrested, but nothing stopped it";
  return {};
}

}  // namespace

std::string check_growth(const GrowthResult& r, const TriangleBvh& body, const GrowthOptions& options) {
  if (r.outcome != GrowthOutcome::kComplete && r.outcome != GrowthOutcome::kArrested) {
    if (r.reason.empty()) return "no crack and no reason";
    return r.sheet.triangles.empty() ? std::string() : "no crack, but a sheet";
  }
  if (std::string bad = check_sheet(r.sheet); !bad.empty()) return bad;
  if (std::string bad = check_border(r, body); !bad.empty()) return bad;
  std::string reason;
  if (options.thickness > 0 || options.thickness_field)
    thicken(r.sheet, {options.thickness, options.thickness_field}, reason);
  return reason;
}

}  // namespace sherd
