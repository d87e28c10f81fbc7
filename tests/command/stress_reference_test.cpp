// `sherd stress` against independent finite elements on the same polyhedra. The files exist in development only.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/command/command.h"

namespace sherd::test {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> fields;
  for (std::string f; std::getline(in, f, ',');) fields.push_back(f);
  return fields;
}

class ValidationStressReference : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    if (!fs::exists(kReferences)) GTEST_SKIP() << "no reference files here";
  }

  static std::vector<double> column(const fs::path& file, const std::string& name) {
    std::istringstream in(read(file));
    std::string line;
    std::getline(in, line);
    const std::vector<std::string> header = split(line);
    const auto at = static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
    std::vector<double> values;
    while (std::getline(in, line)) values.push_back(std::stod(split(line).at(at)));
    return values;
  }

  // One run for the points on the surface and inside; asserts the bands, in percent: rms of the error in max_principal
  // relative to the rms of the reference.
  void expect_within(const std::string& name, int refine, double surface, double inside) const {
    const fs::path folder = kReferences / name;
    const auto info = nlohmann::json::parse(read(folder / "info.json"));
    std::string force;
    for (int i = 0; i < 6; ++i) force += fmt::format("{}{}", i > 0 ? "," : "", info.at("body").at(i).get<double>());
    const std::string on = read(folder / "surface_points.csv"), in = read(folder / "interior_points.csv");
    write("points.csv", on + in.substr(in.find('\n') + 1));
    const Outcome o = sherd(fmt::format(
        "stress '{0}/surface.ply' --traction '{0}/traction.csv' --young {1} --poisson {2} --body-force={3} --points "
        "points.csv --out OUT.csv --json STATS.json --refine {4}",
        folder.string(), info.at("E").get<double>(), info.at("nu").get<double>(), force, refine));
    ASSERT_EQ(o.code, 0) << o.errors;
    const auto statistics = nlohmann::json::parse(read(folder_ / "STATS.json"));
    EXPECT_LT(statistics.at("net_force_residual"), 1e-9);  // what twelve digits of tractions leave
    EXPECT_LT(statistics.at("net_moment_residual"), 1e-9);
    const std::vector<double> value = column(folder_ / "OUT.csv", "max_principal"),
                              reference = column(folder_ / "points.csv", "max_principal");
    ASSERT_EQ(value.size(), reference.size());
    const auto split_at = static_cast<std::size_t>(std::count(on.begin(), on.end(), '\n') - 1);
    const auto error = [&](std::size_t first, std::size_t last) {
      double difference2 = 0, size2 = 0;
      for (std::size_t i = first; i < last; ++i)
        difference2 += std::pow(value[i] - reference[i], 2), size2 += std::pow(reference[i], 2);
      return 100 * std::sqrt(difference2 / size2);
    };
    const double at_surface = error(0, split_at), below = error(split_at, value.size());
    std::printf("%s, refine %d: rms %.2f %% on the surface, %.2f %% inside\n", name.c_str(), refine, at_surface, below);
    EXPECT_LT(at_surface, surface);
    EXPECT_LT(below, inside);
  }

  const fs::path kReferences = fs::path(SHERD_SHARED) / "references";
};

class SlowStressReference : public ValidationStressReference {};

// The reference's own uncertainty is 0.2 to 2 % (plate least, statue most); bands half as wide again as measured.
TEST_F(ValidationStressReference, ThePlateBendsWithinAPercentAndAHalf) {
  expect_within("plate_patch", 0, 1, 1.2);
}
TEST_F(ValidationStressReference, TheNotchedBarIsWithinThreePercentAndInsideOne) {
  expect_within("notched_bar", 0, 2.7, 1);
}
// Fits read the statue as smooth up to 35 degrees, where the reference has the kinks between the facets.
TEST_F(ValidationStressReference, TheStatueIsWithinFifteenPercentAndInsideSeven) {
  expect_within("bunny_squeeze", 0, 14, 7);
}
TEST_F(SlowStressReference, RefinedOnceThePlateIsWithinOnePercent) {
  expect_within("plate_patch", 1, 1, 1);
}
TEST_F(SlowStressReference, RefinedOnceTheNotchedBarIsWithinTwoPercentAndInsideAThird) {
  expect_within("notched_bar", 1, 2, 0.33);
}
TEST_F(SlowStressReference, RefinedOnceTheStatueIsWithinSevenPercentAndInsideTwo) {
  expect_within("bunny_squeeze", 1, 7, 2);
}

}  // namespace
}  // namespace sherd::test
