// Petrov-Galerkin testing of operator rows: from rows at Gauss points of a few panels to rows of the vertices whose
// shape functions reach those panels. The transposed reconstruction, applied from the left.
#pragma once
#include "engine/elastostatic/source_block.h"
#include "engine/elastostatic/testing.h"
#include "kernels/core/aligned.h"

namespace sherd {

class RowTester {
 public:
  // Of the Gauss points in groups [first, first + groups) of `testing`. The builder must number vertices locally.
  RowTester(const Testing& testing, std::size_t first, std::size_t groups, SourceBlockBuilder& builder);

  struct Work {
    AlignedNumbers freedoms, rows;
  };
  // Eight columns at a time in the lanes: `batch` holds the groups' lane blocks (one per column) `stride` numbers
  // apart; columns v0 .. v0 + lanes are tested. work.rows then has one lane block a vertex of vertices(), entry
  // [j][i][lane]: column component j, row component i. Not yet divided by the vertex area.
  void test(const double* batch, std::size_t stride, std::size_t v0, std::size_t lanes, Work& work) const;
  const std::vector<std::uint32_t>& vertices() const { return block_.vertices; }

 private:
  SourceBlock block_;
  std::vector<double> weights_;    // kPanelFreedoms a point
  std::vector<std::size_t> slot_;  // of a point's panel in the block
};

}  // namespace sherd
