#include <charconv>
#include <filesystem>

#include "engine/mesh/load.h"
#include "kernels/core/error.h"
#include "kernels/core/random.h"
#include "tools/bench/fmm.h"
#include "tools/sherd/csv.h"

namespace sherd::bench {
namespace {

FmmPoints cube_cloud(std::size_t n) {
  Random random(2);
  FmmPoints out{fmt::format("cube:{}", n), {}};
  out.points.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Real x = random.uniform(), y = random.uniform(), z = random.uniform();
    out.points.push_back({x, y, z});
  }
  return out;
}

FmmPoints surface_cloud(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon), number = colon == std::string::npos ? "" : text.substr(colon + 1);
  std::size_t n = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), n);
  if ((kind != "sphere" && kind != "cube") || number.empty() || error != std::errc{} ||
      end != number.data() + number.size() || n == 0 || n > 200'000'000)
    throw InputError(fmt::format("--surface {}: write sphere:N or cube:N with N points, 1 .. 200000000", text));
  return kind == "sphere" ? sphere_cloud(n) : cube_cloud(n);
}

FmmPoints csv_cloud(const std::string& path) {
  const CsvTable table{path};
  const std::size_t x = table.column("x"), y = table.column("y"), z = table.column("z");
  FmmPoints out{std::filesystem::path(path).filename().string(), {}};
  for (std::size_t i = 0; i < table.rows(); ++i)
    out.points.push_back({table.number(i, x), table.number(i, y), table.number(i, z)});
  if (out.points.empty()) throw InputError(fmt::format("{}: no points; lines of x,y,z are needed", path));
  return out;
}

}  // namespace

FmmPoints sphere_cloud(std::size_t n) {
  Random random(1);
  FmmPoints out{fmt::format("sphere:{}", n), {}};
  out.points.reserve(n);
  while (out.points.size() < n) {
    const Real x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const Real l = norm(Vec3{x, y, z});
    if (l > 0.1 && l < 1) out.points.push_back(Vec3{x, y, z} / l);
  }
  return out;
}

std::vector<FmmPoints> read_clouds(const FmmOptions& o) {
  std::vector<FmmPoints> out;
  for (const std::string& s : o.surfaces) out.push_back(surface_cloud(s));
  if (!o.points.empty()) out.push_back(csv_cloud(o.points));
  if (!o.mesh.empty()) {
    LoadLog log;
    const SurfaceMesh mesh = load_mesh(o.mesh, {}, log);
    out.push_back({std::filesystem::path(o.mesh).filename().string(), mesh.vertices});
  }
  if (out.empty()) out.push_back(sphere_cloud(220332));
  return out;
}

}  // namespace sherd::bench
