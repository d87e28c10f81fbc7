#include "engine/fracture/interior_seed.h"

#include <algorithm>
#include <cmath>

#include "engine/fracture/initiate.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

struct Sample {
  Vec3 place;
  PrincipalStress stress;
  Real relative = 0;  // stress over strength
};

bool is_deep(const TriangleBvh& body, const Vec3& p, Real depth) {
  return body.inside(p) && (depth <= 0 || body.closest(p, depth).face == kNone);
}

std::vector<Sample> ask(const CrackField& field, const ScalarField& strength, const Vec3Column& places) {
  std::vector<PrincipalStress> stress;
  field.principal_stress(places, stress);
  std::vector<Sample> samples(places.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = {places[i], stress[i], stress[i].value / strength.at(places[i])};
    if (!std::isfinite(samples[i].relative)) samples[i].relative = 0;
  }
  return samples;
}

// Points of a cubic lattice about the box's centre that lie deep in the body, x fastest.
Vec3Column lattice(const TriangleBvh& body, Real spacing, Real depth) {
  const Box box = body.box();
  const Vec3 half = 0.5 * (box.high - box.low), centre = box.centre();
  const auto reach = [&](Real length) { return static_cast<int>(std::floor(length / spacing)); };
  const int nx = reach(half.x), ny = reach(half.y), nz = reach(half.z);
  Vec3Column all;
  for (int k = -nz; k <= nz; ++k)
    for (int j = -ny; j <= ny; ++j)
      for (int i = -nx; i <= nx; ++i) all.push_back(centre + spacing * Vec3{Real(i), Real(j), Real(k)});
  std::vector<std::uint8_t> deep(all.size());
  parallel_for(all.size(), 64, [&](std::size_t i) { deep[i] = is_deep(body, all[i], depth); });
  Vec3Column chosen;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (deep[i]) chosen.push_back(all[i]);
  return chosen;
}

// Of the samples within kPlateau of the largest, the one nearest to their centre; the first of equals. Where all is
// compressed, the first of the least.
Sample largest(const std::vector<Sample>& samples) {
  const auto less = [](const Sample& a, const Sample& b) { return a.relative < b.relative; };
  const Sample& greatest = *std::max_element(samples.begin(), samples.end(), less);
  const Real top = greatest.relative;
  if (!(top > 0)) return greatest;
  const auto on_top = [&](const Sample& s) { return s.relative >= (1 - kPlateau) * top; };
  Vec3 sum;
  Real count = 0;
  for (const Sample& s : samples)
    if (on_top(s)) sum += s.place, count += 1;
  const Sample* best = nullptr;
  for (const Sample& s : samples)
    if (on_top(s) && (!best || distance2(s.place, sum / count) < distance2(best->place, sum / count))) best = &s;
  return *best;
}

}  // namespace

std::optional<CrackSeed> find_interior_seed(const TriangleBvh& body, const CrackField& field,
                                            const ScalarField& strength, const InteriorSeedOptions& options) {
  const Vec3 size = body.box().high - body.box().low;
  if (body.triangle_count() == 0 || options.max_points == 0) return std::nullopt;
  const Real spacing =
      std::max(options.spacing, std::cbrt(size.x * size.y * size.z / static_cast<Real>(options.max_points)));
  const std::vector<Sample> first = ask(field, strength, lattice(body, spacing, options.depth));
  if (first.empty()) return std::nullopt;
  Sample best = largest(first);
  for (const Real step : {0.5 * spacing, 0.25 * spacing, 0.125 * spacing}) {
    Vec3Column around;
    for (int k = 0; k < 27; ++k) {
      const Vec3 p = best.place + step * Vec3{Real(k % 3 - 1), Real(k / 3 % 3 - 1), Real(k / 9 - 1)};
      if (k != 13 && is_deep(body, p, options.depth)) around.push_back(p);
    }
    for (const Sample& s : ask(field, strength, around))
      if (s.relative > (1 + kPlateau) * best.relative) best = s;
  }
  if (!(best.relative > options.least)) return std::nullopt;
  return CrackSeed{.position = best.place, .normal = {}, .stress = best.stress, .interior = true};
}

}  // namespace sherd
