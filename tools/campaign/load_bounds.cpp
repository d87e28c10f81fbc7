#include "tools/campaign/load_bounds.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/fracture/initiate.h"
#include "engine/load/earlier_loads.h"
#include "engine/load/surface_load.h"
#include "engine/material/scalar_field.h"
#include "engine/mesh/shapes.h"
#include "engine/step/elastic_settings.h"
#include "engine/step/solid.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "tools/campaign/generations.h"
#include "tools/campaign/voxels.h"

namespace sherd::campaign {
namespace {

constexpr Real kDensity = 2500;          // kg/m^3
constexpr Elastic kMaterial{2e10, 0.2};  // like glass and ceramics
constexpr Real kLargestFriction = 0.8;

// Two blocks with a neck of a third of their width between them.
SurfaceMesh make_dumbbell() {
  return make_voxels(
      {16, 6, 6},
      [](int i, int j, int k) {
        const bool neck = j >= 2 && j < 4 && k >= 2 && k < 4;
        return i < 6 || i >= 10 || neck;
      },
      0.1);
}

// A bar with a slot half its height deep.
SurfaceMesh make_slotted_bar() {
  return make_voxels(
      {20, 4, 4}, [](int i, int j, int) { return i != 10 || j < 2; }, 0.1);
}

// An L of two plates.
SurfaceMesh make_angle() {
  return make_voxels(
      {12, 12, 8}, [](int i, int j, int) { return i < 2 || j < 2; }, 0.1);
}

void add_shards(const std::string& name, SurfaceMesh mesh, std::vector<BoundBody>& out) {
  GenerationOptions o;
  o.least_generations = 1, o.most_generations = 1, o.least_pieces = 1, o.solve = false;
  const GenerationResult r = run_generations(Specimen(name, std::move(mesh)), o);
  for (std::size_t i = 0; i < r.pieces.size(); ++i) out.push_back({fmt::format("{} {}", name, i), r.pieces[i]});
}

struct RandomLoad {
  std::vector<BodyContact> contacts;
  Vec3 omega;
};

Vec3 random_direction(Random& random) {
  for (;;) {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = random.uniform(-1, 1);
    if (norm2(v) > 0.01 && norm2(v) <= 1) return normalized(v);
  }
}

RandomLoad random_load(Solid& solid, std::size_t number, Random& random) {
  const SurfaceMesh& mesh = solid.mesh();
  const Real diagonal = solid.diagonal();
  RandomLoad load;
  Real force = 0;
  for (std::size_t i = 0; i < 1 + number % 3; ++i) {
    // Half of them at vertices: bodies meet with their edges and corners.
    const std::size_t face = random.next() % mesh.triangle_count();
    const bool at_vertex = random.uniform() < 0.5;
    const Vec3 normal = normalized(mesh.area_normal2(face)), any = random_direction(random);
    const Vec3 along = normalized(any - normal * dot(any, normal));
    BodyContact c;
    c.point = at_vertex ? mesh.corner(face, 0) : mesh.centroid(face);
    c.force = (along * random.uniform(0, kLargestFriction) - normal) * random.uniform(0.2, 1);
    c.patch_radius = 0.02 * diagonal * std::exp(random.uniform(0, 2));
    force += norm(c.force);
    load.contacts.push_back(c);
  }
  if (number % 4 == 3)  // of a size that matters beside these forces of a newton
    load.omega = random_direction(random) * std::sqrt(force / (kDensity * diagonal * diagonal * diagonal * diagonal));
  return load;
}

// The contacts a little moved, turned, stronger or weaker, some of them gone, and all in another proportion.
RandomLoad near(const RandomLoad& load, Solid& solid, Random& random) {
  RandomLoad out{{}, load.omega * random.uniform(0, 1.5)};
  const Real all = random.uniform(0.5, 2), moved = random.uniform(0, 0.5), turned = random.uniform(0, 0.3);
  for (BodyContact c : load.contacts) {
    if (!out.contacts.empty() && random.uniform() < 0.1) continue;
    c.point = solid.bvh().closest(c.point + c.patch_radius * moved * random_direction(random)).point;
    c.force = all * (c.force + norm(c.force) * turned * random_direction(random));
    c.patch_radius *= random.uniform(0.9, 1.1);
    out.contacts.push_back(c);
  }
  return out;
}

void check_body(const BoundBody& body, std::uint64_t seed, std::span<BoundResult> out) {
  const auto mesh = std::make_shared<SurfaceMesh>(body.mesh);
  Solid solid(mesh, RootScale{}, 1);
  const MassProperties mass = mass_properties(*mesh, kDensity);
  const ElasticBody& elastic = solid.elastic(kMaterial, elastic_options(SceneSolver{}));
  const ScalarFieldPtr one = constant_field(1);
  Random random(seed);
  RandomLoad before;
  std::vector<SolvedLoad> solved;
  for (std::size_t k = 0; k < out.size(); ++k) {
    BoundResult& r = out[k];
    r.body = body.name, r.load = k;
    if (k % 2 == 0) solved.clear();
    const RandomLoad random_one = solved.empty() ? random_load(solid, k / 2, random) : near(before, solid, random);
    const Real spin = norm(random_one.omega);
    const std::vector<SpreadContact> contacts = spread(*mesh, random_one.contacts, solid.twins(), solid.bvh());
    r.bound = tension_bound(solid.bounded(), contacts, solved, {0, 0, kDensity, spin});
    SurfaceLoad pull;
    pull.patches = contact_patches(*mesh, random_one.contacts, solid.twins(), solid.bvh());
    pull.omega = random_one.omega;
    const Load load = make_load(*mesh, mass, pull);
    const ParticularSolution particular = elastic.particular(load);
    const ElasticSolution solution = elastic.solve(load, particular);
    r.solved = solution.ok, r.reason = solution.reason;
    if (!solution.ok) continue;
    const StressState state(elastic, solid.recovery(), solid.bvh(), load, particular, solution);
    r.tension = strongest_point(*mesh, solid.recovery(), state, *one).stress.value;
    solved = {{contacts, spin, std::max(Real{0}, r.tension)}};
    before = random_one;
  }
}

}  // namespace

std::vector<BoundBody> bound_bodies() {
  std::vector<BoundBody> out{{"box", make_box({1, 1, 1}, 0.2)},
                             {"ball", make_sphere(1, 0.35)},
                             {"bar 5:1", make_bar(5, 1, 1, 0.5)},
                             {"bar 20:1", make_bar(20, 1, 1, 1)},
                             {"rod 13:1", make_cylinder(0.15, 4, 0.2)},
                             {"plate 10:1", make_plate(10, 10, 1, 1.7)},
                             {"plate 20:1", make_plate(20, 20, 1, 2.5)},
                             {"strip", make_plate(20, 3, 1, 1.4)},
                             {"ring", make_torus(1, 0.2, 0.22)},
                             {"shell", make_hollow_sphere(1, 0.8, 0.35)},
                             {"goblet", make_goblet(0.18, 0.04, 0.003, 0.012)},
                             {"dinner plate", make_dinner_plate(0.13, 0.006, 0.022)},
                             {"dumbbell", make_dumbbell()},
                             {"slotted bar", make_slotted_bar()},
                             {"angle", make_angle()},
                             {"plate with holes", make_double_torus(0.1)}};
  add_shards("shard of a plate", make_plate(10, 10, 1, 1), out);
  add_shards("shard of a block", make_box({2, 1, 1}, 0.2), out);
  return out;
}

std::vector<BoundResult> check_bounds(const std::vector<BoundBody>& bodies, std::size_t loads, std::uint64_t seed) {
  std::vector<BoundResult> results(bodies.size() * loads);
  parallel_for(bodies.size(), 1,
               [&](std::size_t i) { check_body(bodies[i], seed + i, std::span(results).subspan(i * loads, loads)); });
  return results;
}

std::string to_text(const std::vector<BoundResult>& results) {
  std::string text = fmt::format("{:<22} {:>6} {:>16} {:>8}\n", "body", "loads", "largest of bound", "median");
  std::size_t over = 0;
  for (std::size_t first = 0; first < results.size();) {
    std::vector<Real> ratio;
    std::size_t last = first;
    for (; last < results.size() && results[last].body == results[first].body; ++last)
      if (results[last].solved) ratio.push_back(results[last].tension / results[last].bound);
    std::sort(ratio.begin(), ratio.end());
    over += static_cast<std::size_t>(ratio.end() - std::upper_bound(ratio.begin(), ratio.end(), 1.0));
    if (ratio.empty()) ratio.push_back(0);
    text += fmt::format("{:<22} {:>6} {:>16.3f} {:>8.3f}\n", results[first].body, last - first, ratio.back(),
                        ratio[ratio.size() / 2]);
    first = last;
  }
  return text + fmt::format("{} loads, {} above their bound\n", results.size(), over);
}

}  // namespace sherd::campaign
