// What a tolerance asks of expansions, and what operations cost: the leaf size follows from both.
#pragma once
#include "kernels/fmm/far_field.h"
#include "kernels/fmm/lists.h"

namespace sherd::fmm {

// Surfaces and cut for a relative L2 error of the values. Throws InputError outside 1e-9 .. 1e-2.
TranslationOptions accuracy_for(Real tolerance);

// Seconds of one core, relative to each other as measured; deterministic, so that plans do not depend on timings.
struct CostModel {
  double pair = 0;              // one source on one target, directly
  double far = 0;               // one multipole to local, all fields
  double surface = 0;           // one point against one point of a surface, all fields
  double box = 0;               // merge and split, and the products at leaves
  double inner = 0, outer = 0;  // points of the surfaces
};
CostModel cost_model(PairSum sum, const std::vector<FarField>& fields, bool single_far, bool single_near);
double cost(const CostModel& model, const Tree& tree, const ListCounts& counts);

}  // namespace sherd::fmm
