#include <gtest/gtest.h>

#include "tests/fracture/crack_support.h"

namespace sherd {
namespace {

const Specimen& sphere() {
  static const Specimen body(make_sphere(1, 0.12));
  return body;
}
const Specimen& hollow() {
  static const Specimen body(make_hollow_sphere(1, 0.5, 0.12));
  return body;
}

// The field, with no stress at all from the given call on: the load is taken away.
class UnloadedField final : public CrackField {
 public:
  UnloadedField(const CrackField& field, int calls) : field_(field), left_(calls) {}
  void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const override {
    field_.principal_stress(points, out);
    if (left_-- > 0) return;
    for (PrincipalStress& s : out) s = {0, {0, 0, 0}};
  }

 private:
  const CrackField& field_;
  mutable int left_;
};

bool same_sheet(const CrackSheet& a, const CrackSheet& b) {
  return a.position == b.position && a.normal == b.normal && a.state == b.state && a.triangles == b.triangles;
}

// Stopped at every `stride`-th step.
void expect_resumes_exactly(const Specimen& body, const CrackField& field, const Vec3& near, int stride) {
  const CrackSeed seed = body.seed_at(body.nearest_vertex(near), field);
  const GrowthResult whole = grow_crack(body.bvh, field, seed, body.options());
  ASSERT_EQ(whole.outcome, GrowthOutcome::kComplete) << whole.reason;
  ASSERT_EQ(whole.ladder_level, 0) << whole.reason;
  int stopped = 0;
  for (int k = 0; k <= 30; k += stride) {
    const GrowthResult part = grow_crack(body.bvh, UnloadedField(field, k), seed, body.options());
    if (part.outcome == GrowthOutcome::kComplete) break;  // nothing was left to be asked
    ASSERT_EQ(part.outcome, GrowthOutcome::kArrested) << k << ": " << part.reason;
    EXPECT_EQ(check_grown(part, body, body.options().thickness), "") << k;
    ++stopped;
    const GrowthResult rest = resume_crack(body.bvh, field, part.sheet, body.options());
    EXPECT_EQ(rest.outcome, GrowthOutcome::kComplete) << k << ": " << rest.reason;
    EXPECT_TRUE(same_sheet(rest.sheet, whole.sheet))
        << k << ": " << rest.sheet.position.size() << " nodes, not " << whole.sheet.position.size();
  }
  EXPECT_GE(stopped, 10 / stride);
}

FunctionField noisy(const Specimen& body, Real amplitude, std::uint64_t seed) {
  return FunctionField(noisy_direction({1, 0.2, 0}, amplitude, 8 * body.h, seed));
}

TEST(ResumeCrack, StoppedAtSomeStepItEndsAsIfItHadNot) {
  expect_resumes_exactly(sphere(), noisy(sphere(), 0.3, 3), {0, 1, 0}, 4);
  expect_resumes_exactly(hollow(), noisy(hollow(), 0.2, 5), {0, 1, 0}, 9);
}

TEST(SlowResumeCrack, StoppedAtAnyStepItEndsAsIfItHadNot) {
  expect_resumes_exactly(sphere(), FunctionField(rotating_direction({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0.5)), {0, 1, 0},
                         1);
  expect_resumes_exactly(sphere(), noisy(sphere(), 0.3, 3), {0, 1, 0}, 1);
  expect_resumes_exactly(hollow(), noisy(hollow(), 0.2, 5), {0, 1, 0}, 1);
}

TEST(ResumeCrack, ACrackResumedTwiceWithoutLoadStaysTheSame) {
  const FunctionField field(noisy_direction({1, 0.2, 0}, 0.3, 8 * sphere().h, 3));
  const CrackSeed seed = sphere().seed_at(sphere().nearest_vertex({0, 1, 0}), field);
  const GrowthResult once = grow_crack(sphere().bvh, UnloadedField(field, 5), seed, sphere().options());
  ASSERT_EQ(once.outcome, GrowthOutcome::kArrested) << once.reason;
  const GrowthResult twice = resume_crack(sphere().bvh, UnloadedField(field, 0), once.sheet, sphere().options());
  EXPECT_EQ(twice.outcome, GrowthOutcome::kArrested) << twice.reason;
  EXPECT_TRUE(same_sheet(once.sheet, twice.sheet));
}

TEST(ResumeCrack, NodesOutsideThePieceThatInheritsItCountAsThrough) {
  // A crack stopped half-way down a cube, and the upper part of the cube, which another crack cut off since.
  const Specimen cube(make_box({1, 1, 1}, 0.08));
  const FunctionField field([](const Vec3& p) { return PrincipalStress{p.y > 0 ? 1.0 : 0.1, {1, 0, 0}}; });
  const CrackSeed seed = cube.seed_at(cube.nearest_vertex({0.03, 0.5, 0}), field);
  const GrowthResult half = grow_crack(cube.bvh, field, seed, cube.options());
  ASSERT_EQ(half.outcome, GrowthOutcome::kArrested) << half.reason;
  SurfaceMesh mesh = make_box({1, 0.4, 1}, 0.08);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) mesh.vertices.set(v, mesh.vertices[v] + Vec3{0, 0.3, 0});
  const Specimen upper(mesh);  // y from 0.1 up: the whole front lies below
  const GrowthResult through = resume_crack(upper.bvh, UnloadedField(field, 0), half.sheet, upper.options());
  EXPECT_EQ(through.outcome, GrowthOutcome::kComplete) << through.reason;
  EXPECT_EQ(check_grown(through, upper, upper.options().thickness), "");
  EXPECT_NEAR(through.area, 0.4, 1e-3);
}

TEST(ResumeCrack, RefusesAFrontThatIsNotTheBorder) {
  const FunctionField field(constant_direction({1, 0, 0}));
  const CrackSeed seed = sphere().seed_at(sphere().nearest_vertex({0, 1, 0}), field);
  GrowthResult r = grow_crack(sphere().bvh, UnloadedField(field, 3), seed, sphere().options());
  ASSERT_EQ(r.outcome, GrowthOutcome::kArrested);
  CrackSheet bad = *r.sheet.stopped;
  std::swap(bad.front[0][0], bad.front[0][1]);
  EXPECT_EQ(resume_crack(sphere().bvh, field, bad, sphere().options()).outcome, GrowthOutcome::kRejectedSeed);
}

}  // namespace
}  // namespace sherd
