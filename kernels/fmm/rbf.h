// The far field of Zhu, Bridson & Greif (2015, section 5), kept as a reference: expansions are densities at points of a
// representing sphere about the box, found by an LU decomposition from the potential at as many points of a checking
// sphere. No compression.
//
// Around the unit box the spheres have size 1.2 and 3.0. Read as diameters: as radii, the representing spheres of two
// boxes that do not touch reach into each other, and no number of points brings the error below 1e-2 (Laplace).
// The paper names no points; here both spheres carry the Fibonacci spiral in the same directions, which makes
// Laplace's matrix symmetric and positive definite. Kelvin's is not, and for some numbers of points it is nearly
// singular: errors above 1; such numbers are found by measuring and passed over.
#pragma once
#include "kernels/fmm/translations.h"

namespace sherd::fmm {

// options.sphere points on either sphere.
Translations rbf_translations(const TranslationOptions& options);

// Root mean square over pairs of points in separated boxes of the expansions' error, relative to the kernel: what
// random sources leave in the far field. Without the error of moving expansions between levels. single: of expansions
// in single precision.
Real rbf_error(const TranslationOptions& options, bool single = false);

// The fewest points tried whose expansions keep the relative L2 error of values below the tolerance, family and ratio
// as given. The near field is exact, but expansions are moved between levels too: measured, errors of sums are 0.3 ..
// 0.6 of rbf_error() on surfaces, 0.6 .. 1.2 in volumes. Throws InputError where expansions of at most kMaxRbfRank
// numbers do not reach the tolerance: below about 1e-8 (Laplace) and 1e-4 (Kelvin); in single precision, 3e-4 and 3e-3.
// Thread safe; remembered.
TranslationOptions rbf_for(TranslationOptions options, Real tolerance, bool single = false);

inline constexpr std::size_t kMaxRbfRank = 480;  // its 316 dense matrices take 582 MB
// Of the dense matrices and of their copy in numbers of `number` bytes.
std::size_t rbf_bytes(const TranslationOptions& options, std::size_t number);

}  // namespace sherd::fmm
