// The stages of an elastostatic solve of a thin-walled body: most of its rows are tested, and many small panels carry
// its contacts.
#include <benchmark/benchmark.h>

#include "engine/body/mass.h"
#include "engine/elastostatic/direct_assembly.h"
#include "engine/elastostatic/single_layer.h"
#include "engine/load/surface_load.h"
#include "kernels/core/parallel.h"
#include "tools/exact/vessels.h"

namespace sherd {
namespace {

const Elastic kMaterial{70e9 / (2 * 1.22), 0.22};

// The goblet stands on a ring of contacts and is hit from the side.
Load standing(const exact::Vessel& vessel) {
  const TriangleBvh bvh(vessel.mesh);
  std::vector<BodyContact> contacts{{vessel.hit, vessel.force, 0, vessel.patch_radius}};
  const Box box = bounding_box(vessel.mesh);
  for (int k = 0; k < 16; ++k) {
    const Real angle = 0.392699 * k;
    contacts.push_back(
        {{0.02 * std::cos(angle), box.low.y, 0.02 * std::sin(angle)}, {0, 1, 0}, 0, 0.02 * box.diagonal()});
  }
  return make_load(vessel.mesh, mass_properties(vessel.mesh, 2400), contacts, build_twins(vessel.mesh), bvh, {});
}

// What an operator and a right-hand side need of a goblet all of whose rows are tested.
struct Prepared {
  exact::Vessel vessel;
  Boundary boundary{vessel.mesh, {}};
  Reconstruction reconstruction{boundary.mesh, kMaterial.nu, {}};
  Testing testing{boundary, reconstruction,
                  std::vector<VertexTest>(boundary.mesh.vertex_count(), VertexTest::kGalerkin)};
  // `edge`: tenths of a millimetre
  explicit Prepared(std::int64_t edge) : vessel(exact::goblet(static_cast<Real>(edge) * 1e-4)) {}
};

void vessel_assembly(benchmark::State& state) {
  const Prepared p(state.range(0));
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  for (auto _ : state) {
    DenseOperator<float> out(p.boundary.mesh.vertex_count());
    assemble_direct(p.boundary, p.reconstruction, kMaterial.nu, p.testing, out);
    benchmark::DoNotOptimize(out.diagonal_block(0));
  }
  state.counters["triangles"] = static_cast<double>(p.boundary.panels.size());
}
BENCHMARK(vessel_assembly)
    ->ArgNames({"edge", "threads"})
    ->ArgsProduct({{90}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

void vessel_right_hand_side(benchmark::State& state) {
  const Prepared p(state.range(0));
  const Load load = standing(p.vessel);
  const ParticularSolution particular(load.body_force, kMaterial);
  const Vec3Column points = p.testing.points();
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  for (auto _ : state)
    benchmark::DoNotOptimize(load_potential(p.boundary, load, particular, kMaterial, {}, points).size());
  state.counters["triangles"] = static_cast<double>(p.boundary.panels.size());
  state.counters["panels"] = static_cast<double>(load.panels.size());
  state.counters["points"] = static_cast<double>(points.size());
}
BENCHMARK(vessel_right_hand_side)
    ->ArgNames({"edge", "threads"})
    ->ArgsProduct({{90}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace sherd
