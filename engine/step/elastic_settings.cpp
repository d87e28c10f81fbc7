#include "engine/step/elastic_settings.h"

namespace sherd {
namespace {

// Collocation at vertices errs by up to 5 % of bending stress up to this many wall thicknesses an edge (the rule in
// engine/mesh/thickness_resolution.h), as much as a material's strength is uncertain, and is set up several times as
// fast.
constexpr Real kRunThinRatio = kCubicCollocationRule.at_5_percent;

}  // namespace

ElasticOptions elastic_options(const SceneSolver& solver) {
  ElasticOptions o;
  o.thin_ratio = kRunThinRatio * solver.edge_factor;
  o.krylov.tolerance = solver.tolerance;
  o.krylov.max_iterations = solver.max_iterations;
  o.testing = solver.thin_walls == ThinWalls::kOff   ? TestingRule::kCollocation
              : solver.thin_walls == ThinWalls::kAll ? TestingRule::kGalerkin
                                                     : TestingRule::kAuto;
  return o;
}

const ResolutionRule& resolution_rule(const SceneSolver& solver) {
  return solver.thin_walls == ThinWalls::kOff ? kCubicCollocationRule : kCubicTestedRule;
}

}  // namespace sherd
