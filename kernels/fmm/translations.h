// What the far field is made of: multipole and local vectors of a cubic box in a compressed basis, and the matrices
// between them. Kernel-independent (Ying, Biros & Zorin 2004): a box is represented by densities on the surface of a
// cube just around it, found from the potential on a larger cube. The densities are then compressed to the k
// combinations that matter for the boxes its expansion is used by (balanced truncation: what sources in the box can
// excite against what well-separated boxes can see), so that no translation is larger than k x k.
//
// Conventions: boxes have side 1 and centre 0; a kernel that falls as 1/l serves all levels. Surface vectors hold `dim`
// numbers a point, point by point.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/core/vec3.h"

namespace sherd::fmm {

// 1 / l, or (ratio I + e e^T) / l with ratio = 3 - 4 nu.
enum class Family : std::uint8_t { kLaplace, kKelvin };

// Surfaces carry 56, 96, 152, 216, 296, 384, 488, 600, 728 points for resolution 4 .. 12. The outer one must be finer:
// with as many points as densities, collocation lets modes through that no source excites (measured: errors up to 1).
struct TranslationOptions {
  Family family = Family::kLaplace;
  Real ratio = 2;  // kKelvin
  int inner = 5, outer = 6;
  Real cut = 1e-4;  // basis vectors kept: Hankel singular values above this part of the largest
  int sphere = 0;   // above 0: this many points on spheres instead, uncompressed (rbf.h), and none of the above three
  bool operator==(const TranslationOptions&) const = default;
};

// Of an offset with components -3 .. 3.
constexpr std::size_t offset_index(int x, int y, int z) {
  return static_cast<std::size_t>((x + 3) * 49 + (y + 3) * 7 + z + 3);
}

struct Translations {
  std::size_t dim = 1, rank = 0;
  std::vector<Vec3> inner, outer;  // surfaces around the box
  // multipole = up * potential on `outer`; density on `outer` = up^T * local.  rank x (dim outer)
  Eigen::MatrixXd up;
  // density on `inner` = spread * multipole; local = spread^T * potential on `inner`.  (dim inner) x rank
  Eigen::MatrixXd spread;
  // Parent's multipole += merge[octant] * child's; child's local += merge[octant]^T * parent's. Octant bits x, y, z.
  std::array<Eigen::MatrixXd, 8> merge;
  // Target's local += flip(to_local[class] * flip(source's multipole)), where flip() negates the coefficients that are
  // odd under the reflections in `flips`. Offset: target minus source, each -3 .. 3.
  std::vector<Eigen::MatrixXd> to_local;
  struct Offset {
    std::uint16_t matrix = 0xFFFF;  // 0xFFFF: not a far pair
    std::uint8_t flips = 0;
  };
  std::array<Offset, 343> offset;    // at offset_index()
  std::vector<std::uint8_t> parity;  // of a coefficient: bits of the axes it is odd in
};

// Made on first use and kept: the same object for the same options. Thread safe.
std::shared_ptr<const Translations> translations(const TranslationOptions& options);

}  // namespace sherd::fmm
