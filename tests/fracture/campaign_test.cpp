// Many random cracks: the robustness that the design promises, as numbers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

#include "tests/fracture/crack_support.h"

namespace sherd {
namespace {

struct Tally {
  int jobs = 0, level0 = 0, dropped = 0, invalid = 0, complete = 0, arrested = 0, rejected = 0;
  std::size_t evaluations = 0;
  double seconds = 0;
};

FunctionField::Function random_field(int kind, const Specimen& body, Random& random) {
  const auto unit = [&] {
    return normalized(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  };
  const Vec3 e = unit();
  const Real diagonal = bounding_box(body.mesh).diagonal();
  if (kind == 0) return constant_direction(e);
  if (kind == 1) return rotating_direction(e, unit(), unit(), 2 / diagonal);
  return noisy_direction(e, 0.3, 8 * body.h, random.next());
}

void run_job(const Specimen& body, int kind, Random& random, Tally& tally) {
  const auto base = random_field(kind, body, random);
  const auto v = static_cast<std::uint32_t>(random.uniform() * static_cast<double>(body.mesh.vertex_count()));
  const bool arrest = random.uniform() < 0.2;
  const Real reach = random.uniform(1, 4) * body.h;
  const Vec3 origin = body.mesh.vertices[v];
  const FunctionField field([&](const Vec3& p) {
    PrincipalStress s = base(p);
    if (arrest) s.value = std::exp2(-distance(p, origin) / reach);
    return s;
  });
  const auto begin = std::chrono::steady_clock::now();
  const GrowthResult r = grow_crack(body.bvh, field, body.seed_at(v, field), body.options());
  if (r.outcome == GrowthOutcome::kRejectedSeed) {
    ++tally.rejected;
    return;
  }
  tally.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  tally.evaluations += field.evaluations;
  ++tally.jobs;
  const std::string bad = check_grown(r, body, body.options().thickness);
  if (!bad.empty()) {
    ++tally.invalid;
    ADD_FAILURE() << bad << " at vertex " << v;
  }
  tally.complete += r.outcome == GrowthOutcome::kComplete;
  tally.arrested += r.outcome == GrowthOutcome::kArrested;
  if (r.outcome == GrowthOutcome::kFailed)
    ++tally.dropped;
  else
    tally.level0 += r.ladder_level == 0;
  if (std::getenv("SHERD_CRACK_LOG") && (r.ladder_level > 0 || r.outcome == GrowthOutcome::kFailed))
    fmt::print("  vertex {} kind {} level {} outcome {}: {}\n", v, kind, r.ladder_level, static_cast<int>(r.outcome),
               r.reason);
}

Tally campaign(const std::string& name, const Specimen& body, std::uint64_t seed, int jobs_per_field) {
  Tally tally;
  for (int kind = 0; kind < 3; ++kind) {
    Random random(seed + static_cast<std::uint64_t>(kind));
    for (const int until = tally.jobs + jobs_per_field; tally.jobs < until && tally.rejected < 1000;)
      run_job(body, kind, random, tally);
  }
  fmt::print(
      "{:14} faces {:6} jobs {:4} level0 {:4} dropped {:2} invalid {} complete {:4} arrested {:3} rejected {:3} ms "
      "{:6.1f} "
      "stress points {:6.0f}\n",
      name, body.mesh.triangle_count(), tally.jobs, tally.level0, tally.dropped, tally.invalid, tally.complete,
      tally.arrested, tally.rejected, 1e3 * tally.seconds / tally.jobs,
      static_cast<double>(tally.evaluations) / tally.jobs);
  return tally;
}

// Shares of the design: level 0 >= 95 % and dropped <= 1 % on solids, 90 % and 1.5 % on the hollow sphere.
void expect_shares(const Tally& t, double level0, double dropped) {
  EXPECT_EQ(t.invalid, 0);
  EXPECT_GE(t.level0, level0 * t.jobs);
  EXPECT_LE(t.dropped, dropped * t.jobs);
}

int jobs() {
  const char* n = std::getenv("SHERD_CRACK_JOBS");
  return n ? std::atoi(n) : 50;
}

// Another campaign: SHERD_CRACK_SEED=n; more jobs a field: SHERD_CRACK_JOBS=n; the troubled ones: SHERD_CRACK_LOG=1.
std::uint64_t seed(std::uint64_t shape) {
  const char* n = std::getenv("SHERD_CRACK_SEED");
  return shape + (n ? 1000 * static_cast<std::uint64_t>(std::atoll(n)) : 0);
}

TEST(SlowCrackCampaign, SphereCracksAreValid) {
  expect_shares(campaign("sphere", Specimen(make_sphere(1, 0.075)), seed(1), jobs()), 0.95, 0.01);
}
TEST(SlowCrackCampaign, CubeCracksAreValid) {
  expect_shares(campaign("cube", Specimen(make_box({1, 1, 1}, 0.05)), seed(2), jobs()), 0.95, 0.01);
}
TEST(SlowCrackCampaign, PlateCracksAreValid) {
  expect_shares(campaign("plate 30:1", Specimen(make_plate(1, 1, 1.0 / 30, 1.0 / 60)), seed(3), jobs()), 0.95, 0.01);
}
TEST(SlowCrackCampaign, HollowSphereCracksAreValid) {
  expect_shares(campaign("hollow sphere", Specimen(make_hollow_sphere(1, 0.6, 0.075)), seed(4), jobs()), 0.90, 0.015);
}

}  // namespace
}  // namespace sherd
