#include "engine/stress/analysis.h"

#include <unistd.h>

#include <algorithm>
#include <array>

#include "engine/mesh/bvh.h"
#include "engine/mesh/solids.h"
#include "engine/stress/analysis_input.h"
#include "engine/stress/analysis_solver.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr Real kBalanced = 1e-6;   // residual net load, relative, that the digits of a text file may leave
constexpr Real kOnSurface = 1e-3;  // of a triangle's longest edge: points this near count as on the surface
constexpr Real kWalls = 0.01;      // share of the surface worth a warning
constexpr std::size_t kNamed = 5;  // points named in one error

struct Member {
  std::vector<std::uint32_t> faces;  // of the mesh given, ascending
  SurfaceMesh mesh;                  // refined: face f of `faces` became children << 2 refine
  std::unique_ptr<TriangleBvh> bvh;  // of the shape before refinement
  Load load;                         // of the last solve, on the refined mesh
  std::unique_ptr<SolidSolver> solver;
};

Real longest_edge(const std::array<Vec3, 3>& c) {
  return std::sqrt(std::max({distance2(c[0], c[1]), distance2(c[1], c[2]), distance2(c[2], c[0])}));
}

std::size_t machine_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && size > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(size) : SIZE_MAX;
}

// Points that cannot be evaluated, collected so that one error names several.
class Refusals {
 public:
  explicit Refusals(const std::vector<std::string>& labels) : labels_(labels) {}
  void add(std::size_t i, const Vec3& x, const std::string& why) {
    if (++count_ <= kNamed)
      text_ += fmt::format("{}point {} ({:.9g}, {:.9g}, {:.9g}) {}", text_.empty() ? "" : "; ",
                           i < labels_.size() ? labels_[i] : std::to_string(i), x.x, x.y, x.z, why);
  }
  void raise() const {
    if (count_ == 0) return;
    throw InputError(count_ > kNamed ? fmt::format("{}; and {} more", text_, count_ - kNamed) : text_);
  }

 private:
  const std::vector<std::string>& labels_;
  std::size_t count_ = 0;
  std::string text_;
};

}  // namespace

struct Analysis::Impl {
  Elastic material;
  AnalysisOptions options;
  std::vector<Member> members;
  std::vector<std::uint32_t> member_of, index_of;  // per face of the mesh given: its solid, its place in Member::faces
  AnalysisReport report;
  std::size_t lasting_warnings = 0;  // those that do not depend on the load

  void add_solids(const SurfaceMesh& mesh);
  void check_resolution();
  void choose_storage(std::size_t unknowns2);
  void build_solvers();
  bool locate_on_face(const Vec3& x, std::uint32_t face, LocatedPoints& points, std::string& why) const;
  bool locate_inside(const Vec3& x, LocatedPoints& points) const;
  void check_load(const Vec3Column& traction, const BodyForce& force) const;
  void set_load(std::size_t s, const Vec3Column& traction, const BodyForce& force);
};

void Analysis::Impl::add_solids(const SurfaceMesh& mesh) {
  member_of.assign(mesh.triangle_count(), kNone), index_of.assign(mesh.triangle_count(), kNone);
  std::size_t unknowns2 = 0;  // sum of squares
  std::vector<SolidFaces> solids = group_shells(mesh);
  for (std::uint32_t s = 0; s < solids.size(); ++s) {
    Member m;
    m.faces = std::move(solids[s].faces);
    for (std::uint32_t i = 0; i < m.faces.size(); ++i) member_of[m.faces[i]] = s, index_of[m.faces[i]] = i;
    m.mesh = extract_faces(mesh, m.faces);
    m.bvh = std::make_unique<TriangleBvh>(m.mesh);
    SolidReport r;
    std::vector<std::uint32_t> label;
    r.first_face = m.faces[0], r.shells = label_components(m.mesh, label);
    // A closed surface has 3/2 edges a triangle, and each level puts a vertex on every edge.
    std::size_t vertices = m.mesh.vertex_count(), triangles = m.mesh.triangle_count();
    for (int level = 0; level < options.refine; ++level) vertices += 3 * triangles / 2, triangles *= 4;
    r.triangles = triangles, r.unknowns = unknowns_of(options.formulation, vertices, triangles);
    unknowns2 += r.unknowns * r.unknowns;
    report.solids.push_back(r);
    members.push_back(std::move(m));
  }
  choose_storage(unknowns2);
  for (Member& m : members) m.mesh = split_triangles(m.mesh, options.refine);
  check_resolution();
}

void Analysis::Impl::check_resolution() {
  const bool direct = options.formulation == Formulation::kDirect;
  const ResolutionRule& rule = direct ? kCubicTestedRule : kLinearCollocationRule;
  for (std::size_t s = 0; s < members.size(); ++s) {
    SolidReport& r = report.solids[s];
    r.resolution = resolution_report(members[s].mesh, rule);
    for (const std::string& text : resolution_warnings(r.resolution, rule))
      report.warnings.push_back(fmt::format("the solid of face {}: {}", r.first_face, text));
    if (!direct && r.resolution.wall_share > kWalls)
      report.warnings.push_back(
          fmt::format("the solid of face {}: {:.0f} % of its surface has a parallel side behind it; the indirect "
                      "formulation gets the bending of such parts wrong however fine the mesh, use the direct one",
                      r.first_face, 100 * r.resolution.wall_share));
  }
}

void Analysis::Impl::choose_storage(std::size_t unknowns2) {
  options.max_bytes = std::min(options.max_bytes, machine_bytes() / 4 * 3);
  report.double_storage = unknowns2 <= options.max_bytes / sizeof(double);
  if (report.double_storage) return;
  const std::string have = fmt::format("more than the {} MiB allowed", options.max_bytes >> 20);
  if (unknowns2 > options.max_bytes / sizeof(float))
    throw InputError(
        fmt::format("{}: {} triangles have {} unknowns, dense operators of {} MiB even in single precision, "
                    "{}; refine less or use a coarser mesh",
                    options.name, report.triangles(), report.unknowns(), (4 * unknowns2) >> 20, have));
  report.warnings.push_back(
      fmt::format("the operators are stored in single precision (stress to about 1e-6): in double "
                  "they would take {} MiB, {}",
                  (8 * unknowns2) >> 20, have));
}

void Analysis::Impl::build_solvers() {
  const StageTimer timer(report.seconds.assemble);
  for (Member& m : members)
    if (!m.solver)
      m.solver = make_solver(m.mesh, material,
                             {.formulation = options.formulation,
                              .feature_angle = options.feature_angle,
                              .tolerance = options.tolerance,
                              .double_storage = report.double_storage,
                              .max_bytes = options.max_bytes});
}

bool Analysis::Impl::locate_on_face(const Vec3& x, std::uint32_t face, LocatedPoints& points, std::string& why) const {
  if (face >= member_of.size()) {
    why = fmt::format("names face {} of {}", face, member_of.size());
    return false;
  }
  const Member& m = members[member_of[face]];
  const auto& c = m.bvh->corners(index_of[face]);
  const Real off = distance(x, closest_point_on_triangle(x, c[0], c[1], c[2]));
  if (off > kOnSurface * longest_edge(c)) {
    why = fmt::format("lies {:.3g} m off face {}", off, face);
    return false;
  }
  const std::uint32_t first = index_of[face] << 2 * options.refine, last = (index_of[face] + 1) << 2 * options.refine;
  std::uint32_t best = first;
  Real nearest = std::numeric_limits<Real>::infinity();
  for (std::uint32_t t = first; t < last && nearest > 0; ++t) {
    const Real d2 =
        distance2(x, closest_point_on_triangle(x, m.mesh.corner(t, 0), m.mesh.corner(t, 1), m.mesh.corner(t, 2)));
    if (d2 < nearest) nearest = d2, best = t;
  }
  points.position.push_back(x), points.solid.push_back(member_of[face]), points.face.push_back(best);
  return true;
}

bool Analysis::Impl::locate_inside(const Vec3& x, LocatedPoints& points) const {
  const auto add = [&](std::uint32_t s) {
    points.position.push_back(x), points.solid.push_back(s), points.face.push_back(kNone);
    return true;
  };
  for (std::uint32_t s = 0; s < members.size(); ++s)
    if (members[s].bvh->inside(x)) return add(s);
  for (std::uint32_t s = 0; s < members.size(); ++s) {
    const TriangleBvh::Closest c = members[s].bvh->closest(x);
    if (std::sqrt(c.distance2) <= kOnSurface * longest_edge(members[s].bvh->corners(c.face))) return add(s);
  }
  return false;
}

void Analysis::Impl::check_load(const Vec3Column& traction, const BodyForce& force) const {
  if (!traction.empty() && traction.size() != member_of.size())
    throw InputError(fmt::format("{}: {} tractions for {} triangles", options.name, traction.size(), member_of.size()));
  for (std::size_t t = 0; t < traction.size(); ++t)
    if (!is_finite(traction[t]))
      throw InputError(fmt::format("{}: the traction of face {} is not finite", options.name, t));
  bool finite = is_finite(force.constant) && is_finite(force.origin);
  for (int i = 0; i < 3; ++i) finite = finite && is_finite(force.linear.row(i));
  if (!finite) throw InputError(fmt::format("{}: the body force is not finite", options.name));
}

void Analysis::Impl::set_load(std::size_t s, const Vec3Column& traction, const BodyForce& force) {
  Member& m = members[s];
  SolidReport& r = report.solids[s];
  m.load = {};
  if (!traction.empty()) {
    m.load.face_traction.resize(m.mesh.triangle_count());
    for (std::size_t t = 0; t < m.mesh.triangle_count(); ++t)
      m.load.face_traction.set(t, traction[m.faces[t >> 2 * options.refine]]);
  }
  m.load.body_force = balanced_force(m.mesh, m.load.face_traction, force, r);
  if (std::max(r.force_residual, r.moment_residual) <= kBalanced) return;
  report.warnings.push_back(fmt::format(
      "the load on the solid of face {} does not balance: net force ({:.6g}, {:.6g}, {:.6g}) N is {:.2e} of "
      "the forces, net moment ({:.6g}, {:.6g}, {:.6g}) N m about the centroid is {:.2e} of forces times half "
      "the diagonal; a rigid acceleration (body force) takes it up",
      r.first_face, r.net_force.x, r.net_force.y, r.net_force.z, r.force_residual, r.net_moment.x, r.net_moment.y,
      r.net_moment.z, r.moment_residual));
}

Analysis::Analysis(const SurfaceMesh& mesh, const Elastic& material, const AnalysisOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->material = material, impl_->options = options;
  const StageTimer timer(impl_->report.seconds.check);
  require_options(options);
  require_material(material, options.name);
  require_solids(mesh, options.name);
  impl_->add_solids(mesh);
  impl_->lasting_warnings = impl_->report.warnings.size();
}
Analysis::~Analysis() = default;
Analysis::Analysis(Analysis&&) noexcept = default;
Analysis& Analysis::operator=(Analysis&&) noexcept = default;

const AnalysisReport& Analysis::report() const {
  return impl_->report;
}

LocatedPoints Analysis::locate(const Vec3Column& points, const std::vector<std::uint32_t>& face,
                               const std::vector<std::string>& labels) const {
  SHERD_CHECK(face.empty() || face.size() == points.size(), "{} faces for {} points", face.size(), points.size());
  const StageTimer timer(impl_->report.seconds.check);
  LocatedPoints out;
  Refusals refusals(labels);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 x = points[i];
    std::string why;
    if (!is_finite(x))
      refusals.add(i, x, "is not finite");
    else if (!face.empty() && face[i] != kNone) {
      if (!impl_->locate_on_face(x, face[i], out, why)) refusals.add(i, x, why);
    } else if (!impl_->locate_inside(x, out))
      refusals.add(i, x, "lies outside of every solid");
  }
  refusals.raise();
  return out;
}

bool Analysis::solve(const Vec3Column& traction, const BodyForce& force) {
  AnalysisReport& report = impl_->report;
  impl_->check_load(traction, force);
  report.warnings.resize(impl_->lasting_warnings);
  impl_->build_solvers();
  for (std::size_t s = 0; s < impl_->members.size(); ++s) {
    SolidReport& r = report.solids[s];
    impl_->set_load(s, traction, force);
    impl_->members[s].solver->solve(impl_->members[s].load, r, report.seconds);
    if (!r.converged)
      report.warnings.push_back(fmt::format("the solid of face {} did not converge: {}", r.first_face, r.reason));
  }
  return report.solved();
}

void Analysis::stress(const LocatedPoints& points, std::vector<Sym3>& out) {
  const StageTimer timer(impl_->report.seconds.evaluate);
  out.assign(points.size(), {});
  for (std::uint32_t s = 0; s < impl_->members.size(); ++s) {
    std::vector<std::size_t> inside, on;
    std::vector<std::uint32_t> face;
    Vec3Column x, y;
    const StressField* field = impl_->members[s].solver ? impl_->members[s].solver->field() : nullptr;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points.solid[i] != s) continue;
      SHERD_CHECK(field != nullptr, "solid {} has no solution", s);
      if (points.face[i] == kNone)
        inside.push_back(i), x.push_back(points.position[i]);
      else
        on.push_back(i), y.push_back(points.position[i]), face.push_back(points.face[i]);
    }
    std::vector<Sym3> sigma;
    if (!inside.empty()) field->evaluate(x, sigma);
    for (std::size_t k = 0; k < inside.size(); ++k) out[inside[k]] = sigma[k];
    sigma.resize(on.size());
    if (!on.empty()) field->on_faces(y, face, sigma);
    for (std::size_t k = 0; k < on.size(); ++k) out[on[k]] = sigma[k];
  }
}

std::size_t AnalysisReport::triangles() const {
  std::size_t n = 0;
  for (const SolidReport& s : solids) n += s.triangles;
  return n;
}
std::size_t AnalysisReport::unknowns() const {
  std::size_t n = 0;
  for (const SolidReport& s : solids) n += s.unknowns;
  return n;
}
int AnalysisReport::iterations() const {
  int n = 0;
  for (const SolidReport& s : solids) n += s.iterations;
  return n;
}
int AnalysisReport::products() const {
  int n = 0;
  for (const SolidReport& s : solids) n += s.products;
  return n;
}
Real AnalysisReport::residual() const {
  Real worst = 0;
  for (const SolidReport& s : solids) worst = std::max(worst, s.residual);
  return worst;
}
Real AnalysisReport::force_residual() const {
  Real worst = 0;
  for (const SolidReport& s : solids) worst = std::max(worst, s.force_residual);
  return worst;
}
Real AnalysisReport::moment_residual() const {
  Real worst = 0;
  for (const SolidReport& s : solids) worst = std::max(worst, s.moment_residual);
  return worst;
}
bool AnalysisReport::solved() const {
  return std::all_of(solids.begin(), solids.end(), [](const SolidReport& s) { return s.solved; });
}

}  // namespace sherd
