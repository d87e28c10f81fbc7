// One panel's part of the operator's rows, shared by the dense rows (operator_rows.h) and the near field of the fast
// ones (near_field.h).
#pragma once
#include "engine/elastostatic/operator_rows.h"

namespace sherd {

const LaneTables& lane_tables();

// The same weights at the points of kGauss3 for the ten nodes.
struct NodeTables {
  double s[cubic::kNodes][3], t[cubic::kNodes][3], shape[cubic::kNodes][3];
};
const NodeTables& node_tables();

LaneConstants lane_constants(Real nu);

// Closed forms of a panel at the targets with `wanted` 1 (which is overwritten), zero at the others; `on` is 1 for
// targets on the panel.
void closed_forms(const PanelFrame& panel, const double* x, const double* on, double* wanted,
                  const LaneConstants& constants, const LaneKernels& kernels, LaneMoments& out);

// Adds a panel that some targets are within the closed form's reach of to its freedoms (lane_kernels.h); the other
// targets take the six-point rule.
void add_near_panel(const Boundary& boundary, const TargetGroup& targets, std::uint32_t triangle,
                    const LanePanel& panel, const std::uint32_t* local, const LaneConstants& constants,
                    const LaneKernels& kernels, double* freedoms, double* total);

}  // namespace sherd
