#include "engine/step/guided_event.h"

#include "engine/fracture/guide.h"
#include "engine/step/crack_event.h"

namespace sherd {

FractureResult crack_along(Solid& solid, const GuideSpec& spec, const FractureOptions& options) {
  FractureResult result;
  result.volume_before = result.volume_after = solid.mesh_volume();
  FractureOptions once = options;
  once.rounds = 1;  // a guide may cut a piece several times, nothing is solved between
  CrackEvent event(solid, once, result);
  try {
    const Guide guide(spec, solid.bvh(), solid.mesh(), solid.edge_length());
    event.start_along(guide, options.fields.strength->upper());
  } catch (const std::exception& e) {  // this crack is dropped, the run goes on
    CrackRecord& failed = result.cracks.emplace_back();
    failed.cause = CrackCause::kGuide, failed.outcome = "failed", failed.reason = e.what();
  }
  event.finish();
  measure(result);
  return result;
}

}  // namespace sherd
