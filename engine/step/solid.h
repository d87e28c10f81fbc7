// What the fracture of a body needs besides its motion: the mesh the stress is solved on, cracks that stopped inside it, and
// the parts that depend on the mesh alone, built when first asked for and kept as long as the mesh lives.
#pragma once
#include <memory>
#include <vector>

#include "engine/body/mass.h"
#include "engine/fracture/sheet.h"
#include "engine/stress/stress.h"

namespace sherd {

// A crack that stopped inside is kept as a sheet beside the *clean* mesh (without its notch): the stress is solved on the
// clean mesh and the sheet grows on from it later (design O13). The two walls of a notch lie a thousandth of an edge apart, and
// a displacement formulation degenerates there; so a stopped crack is seen and resumes at the lower propagation strength, but
// does not redistribute stress before it goes through.
class Solid {
 public:
  Solid(std::shared_ptr<const SurfaceMesh> clean, Real edge_length, Real root_volume)
      : clean_(std::move(clean)), edge_length_(edge_length), root_volume_(root_volume) {}

  const SurfaceMesh& mesh() const { return *clean_; }
  const std::shared_ptr<const SurfaceMesh>& shared_mesh() const { return clean_; }
  Real edge_length() const { return edge_length_; }    // target edge h, m
  Real root_volume() const { return root_volume_; }    // of the scene body this came from, m^3
  std::vector<CrackSheet> partial;                     // cracks that stopped inside

  const std::vector<std::uint32_t>& twins();
  const TriangleBvh& bvh();
  const SurfaceRecovery& recovery();
  // Built with the first call: one material a body.
  const ElasticBody& elastic(const Elastic& material, const ElasticOptions& options);
  bool has_elastic() const { return elastic_ != nullptr; }
  void drop_elastic() { elastic_.reset(); }            // frees the dense operator

 private:
  std::shared_ptr<const SurfaceMesh> clean_;
  Real edge_length_, root_volume_;
  std::vector<std::uint32_t> twins_;
  std::unique_ptr<TriangleBvh> bvh_;
  std::unique_ptr<SurfaceRecovery> recovery_;
  std::unique_ptr<ElasticBody> elastic_;
};

}  // namespace sherd
