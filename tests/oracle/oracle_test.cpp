// Results of the crack campaign before judges that are not ours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/mesh/shapes.h"
#include "tests/oracle/oracle.h"
#include "tools/campaign/campaign.h"

namespace sherd {
namespace {

using namespace campaign;

struct Judged {
  const Specimen* specimen;
  Crack crack;
  std::string name;
};

// More with SHERD_ORACLE_PAIRS=n, for all shapes together.
std::size_t wanted() {
  const char* n = std::getenv("SHERD_ORACLE_PAIRS");
  return n ? static_cast<std::size_t>(std::atoll(n)) : 210;
}

const std::vector<Specimen>& specimens() {
  static const std::vector<Specimen> all = [] {
    std::vector<Specimen> s;
    s.emplace_back("oracle sphere", make_sphere(1, 0.15));
    s.emplace_back("oracle cube", make_box({1, 1, 1}, 0.1));
    s.emplace_back("oracle plate", make_plate(1, 1, 0.06, 0.04));
    s.emplace_back("oracle hollow", make_hollow_sphere(1, 0.6, 0.15));
    s.emplace_back("oracle torus", make_torus(1, 0.4, 0.15));
    return s;
  }();
  return all;
}

// `wanted()` cracks that were accepted, one shape and field after the other. Grown again for each test.
std::vector<Judged> judged_cracks() {
  std::vector<Judged> cracks;
  for (std::size_t i = 0; cracks.size() < wanted() && i < 10 * wanted(); ++i) {
    const Specimen& s = specimens()[i % specimens().size()];
    const FieldKind field = all_fields()[i / specimens().size() % all_fields().size()];
    Judged j{&s, {}, {}};
    const JobResult job = run_job(s, field, i, {}, &j.crack);
    j.name = s.name + ", " + to_string(field) + ", job " + std::to_string(i);
    EXPECT_EQ(job.report.invalid, "") << j.name;
    if (job.report.outcome != CrackOutcome::kRejected && job.report.outcome != CrackOutcome::kDropped)
      cracks.push_back(std::move(j));
  }
  EXPECT_EQ(cracks.size(), wanted());
  return cracks;
}

// Signed volumes of all connected surfaces of the fragments, largest first.
std::vector<double> shell_volumes(const std::vector<SurfaceMesh>& fragments) {
  std::vector<double> volumes;
  for (const SurfaceMesh& f : fragments) {
    std::vector<std::uint32_t> label;
    std::vector<double> part(label_components(f, label), 0);
    for (std::size_t t = 0; t < f.triangle_count(); ++t)
      part[label[t]] += dot(f.corner(t, 0), cross(f.corner(t, 1), f.corner(t, 2))) / 6;
    volumes.insert(volumes.end(), part.begin(), part.end());
  }
  std::sort(volumes.rbegin(), volumes.rend());
  return volumes;
}

// The same volumes one by one to `tolerance`; what is smaller may be missing on either side (dust).
void expect_same(std::vector<double> ours, std::vector<double> theirs, double tolerance, double dust,
                 const std::string& name) {
  const auto small = [&](double v) { return std::abs(v) <= dust + tolerance; };
  std::erase_if(ours, small), std::erase_if(theirs, small);
  ASSERT_EQ(ours.size(), theirs.size()) << name;
  for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(ours[i], theirs[i], tolerance) << name;
}

TEST(SlowOracle, CgalFindsEveryFragmentClosedEmbeddedAndOfOurVolume) {
  for (const Judged& j : judged_cracks())
    for (const SurfaceMesh& f : j.crack.cut.fragments) {
      const OracleAnswer answer = cgal_check(f);
      ASSERT_TRUE(answer.ok) << j.name << ": " << answer.reason;
      EXPECT_TRUE(answer.closed) << j.name << ": " << answer.reason;
      EXPECT_TRUE(answer.embedded) << j.name;
      // Sums of some thousand terms in two orders: 1e-12 of the body at most.
      expect_same(shell_volumes({f}), answer.volumes, 1e-12 * j.specimen->body.volume(), 0, j.name);
    }
}

TEST(SlowOracle, CgalCutsTheSameSolidsToNineDigits) {
  for (const Judged& j : judged_cracks()) {
    const OracleAnswer answer = cgal_difference(j.specimen->mesh(), j.crack.slab);
    ASSERT_TRUE(answer.ok) << j.name << ": " << answer.reason;
    const double volume = j.specimen->body.volume();
    expect_same(shell_volumes(j.crack.cut.fragments), answer.volumes, 1e-9 * volume, j.crack.cut.dust_volume, j.name);
  }
}

TEST(SlowOracle, ManifoldAgreesWithEveryFragmentAndCut) {
  if (std::string why; !manifold_available(why)) GTEST_SKIP() << why;
  const std::vector<Judged> cracks = judged_cracks();
  std::vector<MeshPair> fragments, cuts;
  for (const Judged& j : cracks) {
    cuts.push_back({&j.specimen->mesh(), &j.crack.slab});
    for (const SurfaceMesh& f : j.crack.cut.fragments) fragments.push_back({&f, nullptr});
  }
  const std::vector<OracleAnswer> checked = manifold_difference(fragments), cut = manifold_difference(cuts);
  // Single precision: coordinates to 6e-8 of about one body, so volumes to about 6e-8 area x size; ten times that.
  constexpr double kTolerance = 1e-5;
  const auto sum = [](const std::vector<double>& v) {
    double s = 0;
    for (const double x : v) s += x;
    return s;
  };
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    ASSERT_TRUE(checked[i].ok) << checked[i].reason;
    EXPECT_TRUE(checked[i].closed);
    const double volume = signed_volume(*fragments[i].body);
    EXPECT_NEAR(sum(checked[i].volumes), volume, kTolerance * specimens()[0].body.volume());
  }
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    ASSERT_TRUE(cut[i].ok) << cracks[i].name << ": " << cut[i].reason;
    const double volume = cracks[i].specimen->body.volume();
    EXPECT_NEAR(sum(cut[i].volumes), sum(shell_volumes(cracks[i].crack.cut.fragments)),
                kTolerance * volume + cracks[i].crack.cut.dust_volume)
        << cracks[i].name;
  }
}

}  // namespace
}  // namespace sherd
