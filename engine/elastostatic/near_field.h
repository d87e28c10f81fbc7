// What the fast operator (fast_operator.h) stores: the difference between the exact rows and three point sources a
// panel, for panels near the target, contracted to vertex-by-vertex blocks.
#pragma once
#include "engine/elastostatic/reconstruction.h"
#include "engine/elastostatic/testing.h"

namespace sherd {

class NearField {
 public:
  // Panels whose centroid is within this many of their longest edges are near. Of smooth displacements 4 leaves 5e-7
  // (sphere) to 1e-6 (plate) against the dense operator's rules, which reach to 8.
  static constexpr Real kReach = 4;
  NearField(const Boundary& boundary, const Reconstruction& reconstruction, Real nu, const Testing& testing);

  // y += N x, both interleaved, three entries a vertex. Parallel; the same bits for any number of threads.
  void add(std::span<const Real> x, std::span<Real> y) const;
  // The double layer of 1 that the difference gives at each point of testing.points(): the own term -u(x) D[1](x) is
  // not part of the blocks.
  const std::vector<Real>& total() const { return total_; }
  // What near panels add to the block of each vertex on itself, exact rather than a difference, without the own term.
  const std::vector<Mat3>& diagonal() const { return diagonal_; }
  std::size_t bytes() const;

 private:
  // Rows of some vertices: blocks row by row.
  struct Piece {
    std::vector<std::uint32_t> row;
    std::vector<std::size_t> begin{0};
    std::vector<std::uint32_t> column;
    std::vector<float> block;  // nine a column, row major
  };
  struct Entry;
  struct Source;
  class Rows;
  void add_collocated(const Source& source);
  void add_tested(const Source& source);
  void merge(std::vector<std::vector<Entry>>& batches);

  std::vector<Piece> pieces_;
  std::vector<Real> total_;
  std::vector<Mat3> diagonal_;
};

}  // namespace sherd
