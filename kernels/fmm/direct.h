// The direct sum over all pairs of points: the oracle of the fast multipole method, and its stand-in for few points.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "kernels/core/column.h"
#include "kernels/fmm/pairs.h"

namespace sherd::fmm {

enum class Precision { kFloat, kDouble };

struct DirectSum {
  PairSum sum;
  const Vec3Column& sources;
  std::span<const double> strengths;  // pair_shape(sum).strengths columns of sources.size() numbers, one after another
  const Vec3Column& targets;
  PairConstants<double> constants;
  Precision precision = Precision::kDouble;
  const Vec3Column* target_normals = nullptr;                           // one a target, where the sum needs them
  std::optional<std::span<const std::uint32_t>> subset = std::nullopt;  // of the targets; otherwise all
  Instructions instructions = best_instructions();
};

// out: pair_shape(sum).outputs columns of as many numbers as there are targets (in the subset), overwritten.
// Coordinates in any unit. The same bits for any number of threads. Throws InputError where sizes do not fit or a
// number is not finite.
//
// kFloat: pairs in single precision, sums over tiles of 128 neighbouring sources in double. Coordinates are relative to
// the middle of the tile, so a pair's distance is wrong by about 1e-7 of itself or of the tile's size, whichever is
// more; points that differ by less than that may count as coincident. Strengths and lengths are scaled to 1, so their
// units do not matter; the constants themselves must fit a float.
void direct_sum(const DirectSum& direct, std::span<double> out);

}  // namespace sherd::fmm
