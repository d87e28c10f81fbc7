// Gauss rules on triangles (Dunavant 1985; Strang and Fix 1973). Weights sum to 1: multiply by the area.
#pragma once
#include <array>

#include "kernels/core/vec3.h"

namespace sherd {

struct TrianglePoint {
  Real a, b, c;  // barycentric coordinates
  Real weight;
};

// Exact for degree 2.
inline constexpr std::array<TrianglePoint, 3> kGauss3 = {
    {{2.0 / 3, 1.0 / 6, 1.0 / 6, 1.0 / 3}, {1.0 / 6, 2.0 / 3, 1.0 / 6, 1.0 / 3}, {1.0 / 6, 1.0 / 6, 2.0 / 3, 1.0 / 3}}};
// Exact for degree 4.
inline constexpr Real kSixA = 0.44594849091596488632, kSixB = 0.09157621350977074346;
inline constexpr Real kSixWa = 0.22338158967801146570, kSixWb = 0.10995174365532186764;
inline constexpr std::array<TrianglePoint, 6> kGauss6 = {{{1 - 2 * kSixA, kSixA, kSixA, kSixWa},
                                                          {kSixA, 1 - 2 * kSixA, kSixA, kSixWa},
                                                          {kSixA, kSixA, 1 - 2 * kSixA, kSixWa},
                                                          {1 - 2 * kSixB, kSixB, kSixB, kSixWb},
                                                          {kSixB, 1 - 2 * kSixB, kSixB, kSixWb},
                                                          {kSixB, kSixB, 1 - 2 * kSixB, kSixWb}}};
// Exact for degree 5 (Radon).
inline constexpr Real kRadonA = 0.47014206410511508977, kRadonB = 0.10128650732345633880;
inline constexpr Real kRadonWa = 0.13239415278850618074, kRadonWb = 0.12593918054482715260;
inline constexpr std::array<TrianglePoint, 7> kGauss7 = {{{1.0 / 3, 1.0 / 3, 1.0 / 3, 0.225},
                                                          {1 - 2 * kRadonA, kRadonA, kRadonA, kRadonWa},
                                                          {kRadonA, 1 - 2 * kRadonA, kRadonA, kRadonWa},
                                                          {kRadonA, kRadonA, 1 - 2 * kRadonA, kRadonWa},
                                                          {1 - 2 * kRadonB, kRadonB, kRadonB, kRadonWb},
                                                          {kRadonB, 1 - 2 * kRadonB, kRadonB, kRadonWb},
                                                          {kRadonB, kRadonB, 1 - 2 * kRadonB, kRadonWb}}};

}  // namespace sherd
