// Pieces of pieces stay sound, and fit for the stress stage (the design's T2).
#include "tools/campaign/generations.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/mesh/shapes.h"

namespace sherd::campaign {
namespace {

void expect_sound(const GenerationResult& result) {
  fmt::print("{}\n{}", generation_header(), to_text(result));
  for (const GenerationRow& row : result.rows) {
    EXPECT_EQ(row.invalid, 0u) << row.generation;
    EXPECT_EQ(row.certified, row.pieces) << row.generation;
    EXPECT_EQ(row.below_1_degree, 0u) << row.generation;
    EXPECT_EQ(row.dropped, 0u) << row.generation;
  }
  EXPECT_LT(result.volume_error, 1e-3);   // of the body, cracks counted as thickness x area
  EXPECT_LT(result.removed_error, 0.02);  // the slab is t thick along normals: bends cost t x curvature
}

TEST(Generations, PiecesOfOneGenerationAreSound) {
  GenerationOptions o;
  o.least_generations = o.most_generations = 1, o.least_pieces = 2;
  for (const Specimen& s :
       {Specimen("small cube", make_box({1, 1, 1}, 0.15)), Specimen("small hollow", make_hollow_sphere(1, 0.6, 0.2))}) {
    const GenerationResult result = run_generations(s, o);
    expect_sound(result);
    EXPECT_GE(result.pieces.size(), 4u);
    EXPECT_EQ(result.solvable, result.pieces.size());
  }
}

TEST(SlowGenerations, SixtyFourPiecesAreSoundAndSolvable) {
  const GenerationResult result = run_generations(Specimen("sphere", make_sphere(1, 0.15)), {});
  expect_sound(result);
  EXPECT_GE(result.pieces.size(), 64u);
  EXPECT_GE(result.solvable, 0.95 * static_cast<Real>(result.pieces.size()));
}

}  // namespace
}  // namespace sherd::campaign
