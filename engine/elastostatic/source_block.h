// Panels that are near each other as the lane kernels want them, with the freedoms, corners and vertices they touch
// numbered locally, so that what a group of targets accumulates stays in the cache.
#pragma once
#include <span>

#include "engine/elastostatic/boundary.h"
#include "engine/elastostatic/lane_kernels.h"
#include "engine/elastostatic/reconstruction.h"

namespace sherd {

struct SourceBlock {
  std::vector<std::uint32_t> panels;
  std::vector<LanePanel> lane_panels;
  std::vector<std::array<std::uint32_t, kPanelFreedoms>> local;  // per panel
  std::size_t freedoms = 0;
  std::vector<LaneGather::Entry> entries;
  std::vector<LaneGather::Term> terms;
  std::vector<LaneGather::Corner> corners;
  std::vector<LaneGather::Gradient> gradients;
  std::vector<std::uint32_t> vertices;  // local -> global, when vertices are numbered locally

  LaneGather gather() const {
    return {entries.data(), entries.size(), terms.data(), corners.data(), corners.size(), gradients.data()};
  }
};

// One builder serves many blocks: its tables are sized once and cleaned after each.
class SourceBlockBuilder {
 public:
  SourceBlockBuilder(const Boundary& boundary, const Reconstruction& reconstruction, bool local_vertices);
  SourceBlock build(std::span<const std::uint32_t> panels);

 private:
  struct CornerTerm {
    std::uint32_t corner;
    LaneGather::Term term;
  };
  void add_freedom(SourceBlock& block, std::uint32_t freedom, std::uint32_t local, std::vector<CornerTerm>& terms);
  void add_corner(SourceBlock& block, std::span<const CornerTerm> terms);
  std::uint32_t vertex(SourceBlock& block, std::uint32_t global);

  const Boundary& boundary_;
  const Reconstruction& reconstruction_;
  bool local_vertices_;
  std::vector<std::uint32_t> freedom_of_, vertex_of_;  // freedoms: vertices, then slopes
};

}  // namespace sherd
