#include "tools/campaign/specimen.h"

#include <functional>

#include "engine/mesh/load.h"
#include "engine/mesh/shapes.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"
#include "tools/campaign/hash.h"

namespace sherd::campaign {
namespace {

struct Source {
  std::string name;
  std::function<SurfaceMesh()> generate;  // empty: a file
  const char* file;
};

const std::vector<Source>& sources() {
  static const std::vector<Source> all{
      {"sphere", [] { return make_sphere(1, 0.075); }, nullptr},
      {"cube",
       [] {
         return make_box({1, 1, 1}, 0.05);
       },
       nullptr},
      {"plate", [] { return make_plate(1, 1, 1.0 / 30, 1.0 / 60); }, nullptr},
      {"hollow", [] { return make_hollow_sphere(1, 0.6, 0.075); }, nullptr},
      {"torus", [] { return make_torus(1, 0.4, 0.08); }, nullptr},
      {"bunny", nullptr, "bunny_20k.ply"},
      {"rocker", nullptr, "rocker_5k.ply"},
      {"cheburashka", nullptr, "cheburashka_13k.ply"},
  };
  return all;
}

}  // namespace

Specimen::Specimen(std::string given, SurfaceMesh surface)
    : name(std::move(given)),
      body(std::move(surface)),
      h(mean_edge_length(mesh())),
      diagonal(bounding_box(mesh()).diagonal()),
      normals(mesh().vertex_count()) {
  for (std::size_t t = 0; t < mesh().triangle_count(); ++t)
    for (const std::uint32_t v : mesh().triangles[t]) normals.add(v, mesh().area_normal2(t));
  const MeshReport report = report_mesh(mesh());
  simply_connected = report.genus == 0;
  hollow = report.components > 1;
}

CrackSeed Specimen::seed_at(std::uint32_t v, const CrackField& field) const {
  Vec3Column p;
  p.push_back(mesh().vertices[v]);
  std::vector<PrincipalStress> s;
  field.principal_stress(p, s);
  CrackSeed seed;
  seed.position = mesh().vertices[v], seed.normal = normalized(normals[v]), seed.stress = s[0], seed.vertex = v;
  return seed;
}

std::uint32_t Specimen::nearest_vertex(const Vec3& p) const {
  std::uint32_t best = 0;
  for (std::uint32_t v = 1; v < mesh().vertex_count(); ++v)
    if (distance2(mesh().vertices[v], p) < distance2(mesh().vertices[best], p)) best = v;
  return best;
}

GrowthOptions Specimen::options() const {
  GrowthOptions o;
  o.edge_length = h;
  o.propagation_strength = 0.5;
  o.thickness = 1e-3 * diagonal;
  return o;
}

std::uint64_t hash_of(const SurfaceMesh& mesh) {
  Hash hash;
  hash.add(mesh.vertices), hash.add(mesh.triangles);
  hash.add(mesh.faces.kind), hash.add(mesh.faces.crack), hash.add(mesh.faces.source);
  return hash.value();
}

const std::vector<std::string>& specimen_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Source& s : sources()) all.push_back(s.name);
    return all;
  }();
  return names;
}

std::unique_ptr<const Specimen> make_specimen(const std::string& name, const std::filesystem::path& meshes) {
  for (const Source& s : sources()) {
    if (s.name != name) continue;
    if (s.generate) return std::make_unique<const Specimen>(name, s.generate());
    const std::filesystem::path file = meshes / s.file;
    if (!std::filesystem::exists(file)) return nullptr;
    LoadLog log;
    return std::make_unique<const Specimen>(name, load_mesh(file.string(), {}, log));
  }
  std::string all;
  for (const std::string& n : specimen_names()) all += (all.empty() ? "" : ", ") + n;
  throw InputError(fmt::format("shape '{}': there are {}", name, all));
}

}  // namespace sherd::campaign
