#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "engine/mesh/load.h"
#include "engine/mesh/load_raw.h"
#include "engine/stress/analysis.h"
#include "kernels/core/error.h"
#include "kernels/core/file.h"
#include "kernels/core/parallel.h"
#include "tools/sherd/commands.h"
#include "tools/sherd/csv.h"

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

// "bx,by,bz[,wx,wy,wz]": b(x) = b + w cross x.
BodyForce parse_body_force(const std::string& text) {
  std::vector<Real> value;
  for (std::size_t at = 0; !text.empty();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    std::size_t position = 0;
    Real v = 0;
    if (!parse_number(next_token(part, position), v) || !std::isfinite(v))
      throw InputError(fmt::format("--body-force {}: '{}' is no finite number", text, part));
    value.push_back(v);
    if (end == text.size()) break;
    at = end + 1;
  }
  if (!value.empty() && value.size() != 3 && value.size() != 6)
    throw InputError(
        fmt::format("--body-force {}: {} numbers; give bx,by,bz or bx,by,bz,wx,wy,wz", text, value.size()));
  BodyForce force;
  if (value.size() >= 3) force.constant = {value[0], value[1], value[2]};
  if (value.size() == 6) force.linear = cross_matrix(Vec3{value[3], value[4], value[5]});
  return force;
}

Elastic parse_material(const StressOptions& o) {
  if (!(o.young > 0) || !std::isfinite(o.young))
    throw InputError(fmt::format("--young {}: must be positive and finite (Pa)", o.young));
  if (!(o.poisson > -1 && o.poisson < 0.5))
    throw InputError(fmt::format("--poisson {}: must lie above -1 and below 0.5", o.poisson));
  return {o.young / (2 * (1 + o.poisson)), o.poisson};
}

// The mesh with every face of the file, in the file's order; what joined its vertices goes to `messages`.
SurfaceMesh load_all_faces(const std::string& path, std::vector<std::string>& messages) {
  LoadLog log;
  SurfaceMesh mesh = load_mesh(path, {}, log);
  for (std::size_t t = 0; t < log.file_triangles; ++t)
    if (t >= mesh.triangle_count() || mesh.faces.source[t] != static_cast<std::int32_t>(t))
      throw InputError(
          fmt::format("{}: face {} (counted from 0) has a vertex twice or is a copy of another face, as {} "
                      "in all; remove them, then number the tractions anew",
                      path, t, log.file_triangles - mesh.triangle_count()));
  for (const std::string& m : log.messages) messages.push_back(fmt::format("{}: {}", path, m));
  return mesh;
}

Vec3Column read_tractions(const std::filesystem::path& path, std::size_t faces) {
  const CsvTable table(path);
  const std::size_t face = table.column("face"), x = table.column("tx"), y = table.column("ty"), z = table.column("tz");
  Vec3Column traction(faces);
  std::vector<std::size_t> given(faces, table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const long long f = table.integer(i, face);
    if (f < 0 || f >= static_cast<long long>(faces))
      table.fail(i, fmt::format("face {} does not exist; the mesh has faces 0 to {}", f, faces - 1));
    const auto at = static_cast<std::size_t>(f);
    if (given[at] != table.rows()) table.fail(i, fmt::format("face {} has a traction in an earlier line", f));
    given[at] = i;
    traction.set(at, {table.number(i, x), table.number(i, y), table.number(i, z)});
  }
  return traction;
}

struct PointFile {
  Vec3Column position;
  std::vector<std::uint32_t> face;
  std::vector<std::string> id;
};

PointFile read_points(const std::filesystem::path& path, std::size_t faces) {
  const CsvTable table(path);
  const std::size_t x = table.column("x"), y = table.column("y"), z = table.column("z");
  const auto face = table.find("face"), id = table.find("id");
  PointFile points;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    points.position.push_back({table.number(i, x), table.number(i, y), table.number(i, z)});
    points.id.push_back(id ? table.text(i, *id) : std::to_string(i));
    const long long f = face ? table.integer(i, *face) : -1;
    if (f < -1 || f >= static_cast<long long>(faces))
      table.fail(i, fmt::format("face {} does not exist; the mesh has faces 0 to {}, -1 means inside", f, faces - 1));
    points.face.push_back(f < 0 ? kNone : static_cast<std::uint32_t>(f));
  }
  return points;
}

LocatedPoints locate(const Analysis& analysis, const PointFile& points, const std::string& path) {
  try {
    return analysis.locate(points.position, points.face, points.id);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
}

// A field that holds a comma is quoted; ids come from a CSV field, which cannot hold a quote.
std::string csv_field(const std::string& text) {
  return text.find(',') == std::string::npos ? text : "\"" + text + "\"";
}

std::string stress_table(const PointFile& points, const std::vector<Sym3>& stress) {
  std::string out = "id,max_principal,sxx,syy,szz,sxy,syz,szx\n";
  for (std::size_t i = 0; i < stress.size(); ++i) {
    const Sym3& s = stress[i];
    out += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", csv_field(points.id[i]),
                       eigen_symmetric(s).value[0], s.xx, s.yy, s.zz, s.xy, s.yz, s.xz);
  }
  return out;
}

Json to_json(const Vec3& v) {
  return {v.x, v.y, v.z};
}

Json solids_json(const AnalysisReport& report) {
  Json solids = Json::array();
  for (const SolidReport& s : report.solids)
    solids.push_back({{"first_face", s.first_face},
                      {"shells", s.shells},
                      {"triangles", s.triangles},
                      {"unknowns", s.unknowns},
                      {"volume", s.volume},
                      {"area", s.area},
                      {"net_force", to_json(s.net_force)},
                      {"net_moment", to_json(s.net_moment)},
                      {"force_residual", s.force_residual},
                      {"moment_residual", s.moment_residual},
                      {"resolution", Json::parse(to_json(s.resolution))},
                      {"iterations", s.iterations},
                      {"products", s.products},
                      {"residual", s.residual},
                      {"converged", s.converged},
                      {"reason", s.reason}});
  return solids;
}

std::string statistics(const StressOptions& o, const AnalysisReport& r, const std::vector<std::string>& warnings,
                       std::size_t points, double load_seconds, double total_seconds) {
  Json out;
  out["mesh"] = o.mesh.string(), out["formulation"] = o.formulation;
  out["refine"] = o.refine, out["feature_angle"] = o.feature_angle, out["tolerance"] = o.tolerance;
  out["solved"] = r.solved(), out["points"] = points;
  out["triangles"] = r.triangles(), out["unknowns"] = r.unknowns();
  out["storage"] = r.double_storage ? "double" : "single";
  out["iterations"] = r.iterations(), out["products"] = r.products(), out["residual"] = r.residual();
  out["net_force_residual"] = r.force_residual(), out["net_moment_residual"] = r.moment_residual();
  const StageSeconds& s = r.seconds;
  out["seconds"] = {{"load", load_seconds}, {"check", s.check},       {"assemble", s.assemble}, {"solve", s.solve},
                    {"recover", s.recover}, {"evaluate", s.evaluate}, {"total", total_seconds}};
  out["peak_memory_bytes"] = peak_memory();
  out["solids"] = solids_json(r);
  out["warnings"] = warnings;
  // File names need not be UTF-8; JSON has to be.
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// Results must not replace what they are computed from.
void require_new(const StressOptions& o, const std::filesystem::path& result) {
  std::error_code error;
  for (const auto& input : {o.mesh, o.tractions, o.points})
    if (!result.empty() && std::filesystem::equivalent(result, input, error) && !error)
      throw InputError(
          fmt::format("{}: is an input of this command; choose another file for the result", result.string()));
}

}  // namespace

int stress_command(const StressOptions& o) {
  const double start = now();
  const ThreadLimit limit(o.threads);
  const BodyForce force = parse_body_force(o.body_force);
  const Elastic material = parse_material(o);
  require_new(o, o.out), require_new(o, o.json);
  std::vector<std::string> warnings;
  const SurfaceMesh mesh = load_all_faces(o.mesh.string(), warnings);
  const Vec3Column traction = read_tractions(o.tractions, mesh.triangle_count());
  const PointFile points = read_points(o.points, mesh.triangle_count());
  const double loaded = now() - start;

  Analysis analysis(mesh, material,
                    {.name = o.mesh.string(),
                     .formulation = o.formulation == "indirect" ? Formulation::kIndirect : Formulation::kDirect,
                     .refine = o.refine,
                     .feature_angle = o.feature_angle,
                     .tolerance = o.tolerance});
  const LocatedPoints located = locate(analysis, points, o.points.string());
  const bool solved = analysis.solve(traction, force);
  std::vector<Sym3> stress;
  if (solved) analysis.stress(located, stress);
  const AnalysisReport& report = analysis.report();
  warnings.insert(warnings.end(), report.warnings.begin(), report.warnings.end());
  for (const std::string& w : warnings) std::fprintf(stderr, "warning: %s\n", w.c_str());
  if (solved) replace_file(o.out, stress_table(points, stress));
  if (!o.json.empty()) replace_file(o.json, statistics(o, report, warnings, points.id.size(), loaded, now() - start));
  if (!solved) {
    std::fprintf(stderr, "%s: no result: the solver failed\n", o.mesh.string().c_str());
    return kFailure;
  }
  std::printf("%zu triangles, %zu unknowns, %d iterations, residual %.1e, %.1f s; stress at %zu points in %s\n",
              report.triangles(), report.unknowns(), report.iterations(), report.residual(), now() - start,
              points.id.size(), o.out.string().c_str());
  return kSuccess;
}

}  // namespace sherd
