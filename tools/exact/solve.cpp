#include "tools/exact/solve.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <numbers>

#include "kernels/core/error.h"
#include "kernels/core/random.h"

namespace sherd::exact {
namespace {

class Clock {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return s;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// Linux can forget the high-water mark; elsewhere the peak is that of the process so far.
void reset_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

double peak_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void solve_direct(Solved& s, const Elastic& material, const Load& load, const SolveOptions& options) {
  Clock clock;
  s.body = std::make_unique<ElasticBody>(s.mesh, material, options.elastic);
  s.seconds.assemble = clock.lap();
  s.unknowns = 3 * s.mesh.vertex_count();
  if (!s.body->ready()) {
    s.reason = s.body->reason();
    return;
  }
  const ParticularSolution particular = s.body->particular(load);
  const ElasticSolution solution = s.body->solve(load, particular);
  s.seconds.solve = clock.lap();
  s.ok = solution.ok, s.reason = solution.reason, s.krylov = solution.krylov;
  if (!s.ok) return;
  s.field = std::make_unique<StressState>(*s.body, *s.recovery, *s.bvh, load, particular, solution);
  s.seconds.stress = clock.lap();
}

void solve_indirect(Solved& s, const Elastic& material, const Load& load, const SolveOptions& options) {
  Clock clock;
  IndirectOptions o;
  o.quadrature = options.elastic.quadrature, o.krylov = options.elastic.krylov, o.method = options.indirect_method;
  o.double_storage = options.elastic.double_storage, o.max_bytes = options.elastic.max_bytes;
  s.indirect = std::make_unique<IndirectBody>(s.mesh, material, o);
  s.seconds.assemble = clock.lap();
  s.unknowns = 3 * s.mesh.triangle_count();
  if (!s.indirect->ready()) {
    s.reason = s.indirect->reason();
    return;
  }
  const ParticularSolution particular(load.body_force, material);
  const IndirectSolution solution = s.indirect->solve(load, particular);
  s.seconds.solve = clock.lap();
  s.ok = solution.ok, s.reason = solution.reason, s.krylov = solution.krylov;
  if (!s.ok) return;
  s.field = std::make_unique<IndirectState>(*s.indirect, *s.recovery, *s.bvh, load, particular, solution);
  s.seconds.stress = clock.lap();
}

class Statistics {
 public:
  void add(Real e) { sum_ += e * e, max_ = std::max(max_, std::abs(e)), ++count_; }
  StressError result() const { return {count_ > 0 ? std::sqrt(sum_ / static_cast<Real>(count_)) : 0, max_, count_}; }

 private:
  Real sum_ = 0, max_ = 0;
  std::size_t count_ = 0;
};

Real max_principal(const Sym3& s) {
  return eigen_symmetric(s).value[0];
}

}  // namespace

std::string_view to_string(Formulation formulation) {
  return formulation == Formulation::kDirect ? "direct" : "indirect";
}

Solved solve(const SurfaceMesh& mesh, const Elastic& material, const Load& load, const SolveOptions& options) {
  Solved s;
  reset_peak_memory();
  s.mesh = mesh;
  Clock clock;
  s.bvh = std::make_unique<TriangleBvh>(s.mesh);
  s.recovery = std::make_unique<SurfaceRecovery>(s.mesh, options.recovery);
  s.seconds.prepare = clock.lap();
  if (options.formulation == Formulation::kDirect)
    solve_direct(s, material, load, options);
  else
    solve_indirect(s, material, load, options);
  s.peak_megabytes = peak_megabytes();
  return s;
}

namespace {

SurfaceError corner_errors(const ExactCase& c, const Solved& solved, const std::vector<Sym3>& sigma) {
  const auto& corners = solved.recovery->corners();
  std::vector<int> groups(solved.mesh.vertex_count(), 0);
  for (const auto& corner : corners) ++groups[corner.vertex];
  Statistics all, free;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 x = solved.mesh.vertices[corners[i].vertex];
    const Real e = (max_principal(sigma[i]) - max_principal(c.stress(x))) / c.peak;
    all.add(e);
    bool loaded = false;
    for (const std::uint32_t f : corners[i].faces)
      loaded = loaded || norm(c.traction(x, normalized(solved.mesh.area_normal2(f)))) > 1e-9 * c.peak;
    if (groups[corners[i].vertex] == 1 || !loaded) free.add(e);
  }
  return {all.result(), free.result()};
}

}  // namespace

SurfaceError surface_error(const ExactCase& c, const Solved& solved) {
  return corner_errors(c, solved, solved.field->corner_stress());
}

SurfaceError recovery_floor(const ExactCase& c, const Solved& solved) {
  Vec3Column u(solved.mesh.vertex_count()), traction(solved.recovery->corners().size());
  for (std::size_t i = 0; i < u.size(); ++i) u.set(i, c.displacement(solved.mesh.vertices[i]));
  for (std::size_t i = 0; i < traction.size(); ++i) {
    const auto& corner = solved.recovery->corners()[i];
    Vec3 sum;
    for (const std::uint32_t f : corner.faces)
      sum += c.traction(solved.mesh.vertices[corner.vertex], normalized(solved.mesh.area_normal2(f)));
    traction.set(i, sum / static_cast<Real>(corner.faces.size()));
  }
  return corner_errors(c, solved, solved.recovery->stress(u, traction, c.material));
}

StressError interior_error(const ExactCase& c, const Solved& solved, Real depth, std::size_t count, Real within) {
  std::vector<std::size_t> faces;
  for (std::size_t t = 0; t < solved.mesh.triangle_count(); ++t)
    if (norm(solved.mesh.centroid(t)) <= within) faces.push_back(t);
  SHERD_CHECK(!faces.empty(), "no face within {} m", within);
  Random random(3);
  Vec3Column points;
  for (std::size_t tried = 0; points.size() < count && tried < 20 * count; ++tried) {
    const std::size_t t = faces[random.next() % faces.size()];
    const Vec3 n2 = solved.mesh.area_normal2(t);
    const Real s = std::sqrt(random.uniform()), v = random.uniform();
    const Vec3 on = solved.mesh.corner(t, 0) * (1 - s) + solved.mesh.corner(t, 1) * (s * (1 - v)) +
                    solved.mesh.corner(t, 2) * (s * v);
    const Real below = depth * std::sqrt(2 * norm(n2) / std::numbers::sqrt3);
    const Vec3 x = on - normalized(n2) * below;
    if (solved.bvh->inside(x) && solved.bvh->closest(x).distance2 > 0.81 * below * below) points.push_back(x);
  }
  std::vector<Sym3> sigma;
  solved.field->evaluate(points, sigma);
  Statistics statistics;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 x = c.nearest_inside ? c.nearest_inside(points[i]) : points[i];
    statistics.add((max_principal(sigma[i]) - max_principal(c.stress(x))) / c.peak);
  }
  return statistics.result();
}

}  // namespace sherd::exact
