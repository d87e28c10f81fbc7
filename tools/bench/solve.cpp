#include "tools/bench/solve.h"

#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/exact/case.h"
#include "tools/exact/solve.h"

namespace sherd::bench {
namespace {

double cpu_seconds() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(u.ru_utime) + seconds(u.ru_stime);
}

OperatorKind kind_of(const std::string& name) {
  return name == "dense" ? OperatorKind::kDense : name == "fast" ? OperatorKind::kFast : OperatorKind::kAuto;
}

}  // namespace

int run_solve(const SolveBenchOptions& o) {
  std::printf(
      "Spherical cavity in a sphere under tension. Error of the largest principal stress at all corners, %% of the "
      "peak.\n%-9s %-6s %6s %8s %9s %8s %8s %8s %8s %9s %8s %9s\n",
      "triangles", "kind", "prod", "prepare", "assemble", "solve", "stress", "wall s", "cpu s", "rms", "max",
      "peak MB");
  nlohmann::json rows = nlohmann::json::array();
  int status = 0;
  for (const std::size_t wanted : o.triangles)
    for (const std::string& name : o.operators) {
      const int frequency = std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(wanted) / 40))));
      const exact::ExactCase c = exact::cavity(frequency, 4);
      exact::SolveOptions options;
      options.elastic.kind = kind_of(name), options.elastic.krylov.tolerance = o.tolerance;
      options.elastic.max_bytes = static_cast<std::size_t>(o.gigabytes * (1 << 30));
      const double cpu = cpu_seconds();
      const auto start = std::chrono::steady_clock::now();
      const exact::Solved s = exact::solve(c, options);
      const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                   spent = cpu_seconds() - cpu;
      if (!s.ok) {
        std::printf("%-9zu %-6s %s\n", c.mesh.triangle_count(), name.c_str(), s.reason.c_str());
        rows.push_back(
            {{"triangles", c.mesh.triangle_count()}, {"operator", name}, {"ok", false}, {"reason", s.reason}});
        status = 1;
        continue;
      }
      const exact::StressError e = exact::surface_error(c, s).all;
      std::printf("%-9zu %-6s %6d %8.2f %9.2f %8.2f %8.2f %8.2f %8.2f %9.4f %8.3f %9.0f\n", c.mesh.triangle_count(),
                  name.c_str(), s.krylov.products, s.seconds.prepare, s.seconds.assemble, s.seconds.solve,
                  s.seconds.stress, wall, spent, 100 * e.rms, 100 * e.max, s.peak_megabytes);
      std::fflush(stdout);
      rows.push_back({{"triangles", c.mesh.triangle_count()},
                      {"operator", name},
                      {"ok", true},
                      {"unknowns", s.unknowns},
                      {"iterations", s.krylov.iterations},
                      {"products", s.krylov.products},
                      {"prepare_s", s.seconds.prepare},
                      {"assemble_s", s.seconds.assemble},
                      {"solve_s", s.seconds.solve},
                      {"stress_s", s.seconds.stress},
                      {"wall_s", wall},
                      {"cpu_s", spent},
                      {"rms", e.rms},
                      {"max", e.max},
                      {"operator_mb", static_cast<double>(s.body->bytes()) / 1048576},
                      {"peak_mb", s.peak_megabytes}});
    }
  if (!o.json.empty()) std::ofstream(o.json) << nlohmann::json{{"solve", rows}}.dump(1) << "\n";
  return status;
}

}  // namespace sherd::bench
