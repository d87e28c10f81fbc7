// Bodies for crack campaigns: generated shapes, and statues from mesh files.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/fracture/grow.h"
#include "engine/fragment/cut_body.h"

namespace sherd::campaign {

struct Specimen {
  Specimen(std::string name, SurfaceMesh mesh);
  const SurfaceMesh& mesh() const { return body.mesh(); }
  // A seed at mesh vertex v under the field's stress there.
  CrackSeed seed_at(std::uint32_t v, const CrackField& field) const;
  std::uint32_t nearest_vertex(const Vec3& p) const;
  // h, propagation strength 0.5 Pa (synthetic fields have 1 Pa), thickness a thousandth of the diagonal.
  GrowthOptions options() const;

  std::string name;
  CutBody body;
  Real h = 0;                     // mean edge, m
  Real diagonal = 0;              // of the bounding box, m
  bool simply_connected = false;  // no handle: every crack that goes through separates
  bool hollow = false;            // has a cavity
  Vec3Column normals;             // per vertex, area-weighted, not normalised
};

// Of every coordinate, index and attribute.
std::uint64_t hash_of(const SurfaceMesh& mesh);

// In the order of the campaign's table: sphere, cube, plate, hollow, torus, bunny, rocker, cheburashka.
const std::vector<std::string>& specimen_names();
// Null when the file of a statue is not in `meshes`. InputError for an unknown name.
std::unique_ptr<const Specimen> make_specimen(const std::string& name, const std::filesystem::path& meshes);

}  // namespace sherd::campaign
