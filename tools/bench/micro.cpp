// Single stages. Report ratios measured in one run: machines differ and are shared.
#include <benchmark/benchmark.h>

#include "engine/contact/distance_field.h"
#include "engine/elastostatic/dense_operator.h"
#include "engine/elastostatic/solver.h"
#include "engine/fragment/cut.h"
#include "engine/mesh/remesh.h"
#include "engine/mesh/shapes.h"
#include "engine/stress/stress.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "kernels/fundamental/kelvin.h"
#include "kernels/quadrature/gauss.h"
#include "kernels/quadrature/moments.h"

namespace sherd {
namespace {

const Elastic kMaterial{1, 0.3};

void panel_closed_form(benchmark::State& state) {
  const PanelFrame f = make_panel({0, 0, 0}, {1, 0.1, 0}, {0.3, 0.9, 0.2});
  Random random(1);
  PanelValues v;
  PanelGradients g;
  for (auto _ : state) {
    const Vec3 x{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
    if (state.range(0))
      integrate_panel_gradient(f, x, Side::kAway, g);
    else
      integrate_panel(f, x, Side::kAway, v);
    benchmark::DoNotOptimize(v), benchmark::DoNotOptimize(g);
  }
}
BENCHMARK(panel_closed_form)->ArgName("gradient")->Arg(0)->Arg(1);

// Quadratic and cubic densities. `far` is beyond eight altitudes, where a Gauss rule replaces the closed form.
void panel_moments(benchmark::State& state) {
  const PanelFrame f = make_panel({0, 0, 0}, {1, 0.1, 0}, {0.3, 0.9, 0.2});
  Random random(1);
  PanelMoments v;
  PanelMomentGradients g;
  const Vec3 offset = f.normal * (state.range(1) ? 12.0 : 0.0);
  for (auto _ : state) {
    const Vec3 x = offset + Vec3{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
    if (state.range(0))
      integrate_panel_moment_gradients(f, x, Side::kAway, g);
    else
      integrate_panel_moments(f, x, Side::kAway, v);
    benchmark::DoNotOptimize(v), benchmark::DoNotOptimize(g);
  }
}
BENCHMARK(panel_moments)->ArgNames({"gradient", "far"})->Args({0, 0})->Args({1, 0})->Args({0, 1})->Args({1, 1});

void panel_gauss7(benchmark::State& state) {
  Random random(1);
  for (auto _ : state) {
    const Vec3 x{random.uniform(3, 5), random.uniform(-2, 2), random.uniform(-2, 2)};
    Vec3 u;
    for (const TrianglePoint& p : kGauss7) u += kelvin::displacement(x - Vec3{p.a, p.b, p.c}, {1, 2, 3}, kMaterial);
    benchmark::DoNotOptimize(u);
  }
}
BENCHMARK(panel_gauss7);

SurfaceMesh sphere_of(std::int64_t triangles) {
  return make_sphere(1, std::sqrt(4 * 3.14159 / (0.433 * static_cast<Real>(triangles))));
}

void operator_assembly(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const Boundary boundary(sphere_of(state.range(0)), QuadratureOptions{});
  for (auto _ : state) benchmark::DoNotOptimize(DenseOperator<float>(boundary, 0.3).size());
  state.counters["triangles"] = static_cast<double>(boundary.panels.size());
}
BENCHMARK(operator_assembly)
    ->ArgNames({"triangles", "threads"})
    ->Args({1500, 1})
    ->Args({1500, 2})
    ->Args({6000, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void operator_product(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const Boundary boundary(sphere_of(state.range(0)), QuadratureOptions{});
  const DenseOperator<float> a(boundary, 0.3);
  std::vector<Real> x(a.size(), 1), y(a.size());
  for (auto _ : state) a.apply(x, y);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(a.size() * a.size() * sizeof(float)));
}
BENCHMARK(operator_product)
    ->ArgNames({"triangles", "threads"})
    ->Args({1500, 1})
    ->Args({1500, 2})
    ->Args({6000, 1})
    ->Args({6000, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void interior_stress(benchmark::State& state) {
  const SurfaceMesh mesh = sphere_of(state.range(0));
  const TriangleBvh bvh(mesh);
  const SurfaceRecovery recovery(mesh, {});
  const ElasticBody body(mesh, kMaterial, {});
  Load load;
  load.body_force.linear[0][0] = 1;
  const ParticularSolution particular(load.body_force, kMaterial);
  const StressState stress(body, recovery, bvh, load, particular, body.solve(load, particular));
  Random random(2);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        stress.interior({random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)}));
}
BENCHMARK(interior_stress)->ArgName("triangles")->Arg(1500)->Arg(6000)->Unit(benchmark::kMicrosecond);

// Displacement gradients inside from so many triangles at so many points: direct (0) and fast (1) sums. A field of
// constants will do.
void interior_gradients(benchmark::State& state) {
  const SurfaceMesh mesh = sphere_of(state.range(0));
  const Boundary boundary(mesh, QuadratureOptions{});
  std::vector<ElementField> elements;
  for (const PanelFrame& f : boundary.panels)
    elements.emplace_back(f, std::array<Vec3, cubic::kNodes>{f.normal}, ElementField::Quadratic{f.normal}, kMaterial);
  const Somigliana somigliana(boundary, elements, kMaterial, {});
  Random random(2);
  Vec3Column x;
  while (std::ssize(x.x) < state.range(1))
    x.push_back({random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)});
  const std::vector<std::uint32_t> face(x.size(), kNone);
  std::vector<Mat3> out(x.size());
  using FarSum = Somigliana::FarSum;
  somigliana.gradients(x, face, out, FarSum::kFast);  // its translations are made once
  for (auto _ : state) somigliana.gradients(x, face, out, state.range(2) ? FarSum::kFast : FarSum::kDirect);
}
BENCHMARK(interior_gradients)
    ->ArgNames({"triangles", "points", "fast"})
    ->ArgsProduct({{10000, 100000}, {2000, 20000}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void solve_thin_plate(benchmark::State& state) {
  const SurfaceMesh mesh = make_plate(1, 1, 0.05, 0.05);
  ElasticOptions options;
  if (state.range(0) == 0) options.deflation.max_dimension = 0;  // one cell: the six rigid motions of eight nodes
  const ElasticBody body(mesh, kMaterial, options);
  Load load;
  load.body_force.linear[0][1] = load.body_force.linear[1][0] = 1;
  const ParticularSolution particular(load.body_force, kMaterial);
  int iterations = 0;
  for (auto _ : state) iterations = body.solve(load, particular).krylov.iterations;
  state.counters["iterations"] = iterations;
}
BENCHMARK(solve_thin_plate)->ArgName("deflated")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void cut_sphere(benchmark::State& state) {
  const SurfaceMesh body = sphere_of(state.range(0));
  SurfaceMesh slab = make_box({3, 0.004, 3}, 0.1);
  for (std::size_t i = 0; i < slab.vertex_count(); ++i)
    slab.vertices.add(i, {0.013, 0.1 + 0.05 * std::sin(3 * slab.vertices[i].x), 0.007});
  for (auto _ : state) benchmark::DoNotOptimize(cut(body, slab, {}).fragments.size());
}
BENCHMARK(cut_sphere)->ArgName("triangles")->Arg(1500)->Arg(6000)->Arg(24000)->Unit(benchmark::kMillisecond);

void remesh_sphere(benchmark::State& state) {
  const SurfaceMesh body = sphere_of(state.range(0));
  RemeshOptions options;
  options.edge_length = 2 * mean_edge_length(body);
  SurfaceMesh out;
  for (auto _ : state) benchmark::DoNotOptimize(remesh(body, options, out).min_angle);
}
BENCHMARK(remesh_sphere)->ArgName("triangles")->Arg(6000)->Arg(24000)->Unit(benchmark::kMillisecond);

void distance_field(benchmark::State& state) {
  const SurfaceMesh body = sphere_of(state.range(0));
  const TriangleBvh bvh(body);
  for (auto _ : state) benchmark::DoNotOptimize(SignedDistanceField(body, bvh).node_count());
}
BENCHMARK(distance_field)->ArgName("triangles")->Arg(1500)->Arg(6000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace sherd
