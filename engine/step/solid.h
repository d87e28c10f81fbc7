// What the fracture of a body needs besides its motion: the mesh the stress is solved on, cracks that stopped inside
// it, and the parts that depend on the mesh alone, built when first asked for and kept as long as the mesh lives.
#pragma once
#include <memory>
#include <vector>

#include "engine/body/mass.h"
#include "engine/fracture/sheet.h"
#include "engine/stress/stress.h"

namespace sherd {

// Lengths that all fragments of a scene body share.
struct RootScale {
  Real edge_length = 0;         // target edge h, m
  Real volume = 0;              // of the scene body, m^3
  Real diagonal = 0;            // of its bounding box, m
  Real edge_per_thickness = 0;  // of the scene body
};

// A crack that stopped inside is kept as a sheet beside the *clean* mesh (without its notch): the stress is solved on
// the clean mesh and the sheet grows on from it later (design O13). The two walls of a notch lie a thousandth of an
// edge apart, and a displacement formulation degenerates there; so a stopped crack is seen and resumes at the lower
// propagation strength, but does not redistribute stress before it goes through.
class Solid {
 public:
  Solid(std::shared_ptr<const SurfaceMesh> clean, const RootScale& root) : clean_(std::move(clean)), root_(root) {}

  const SurfaceMesh& mesh() const { return *clean_; }
  const std::shared_ptr<const SurfaceMesh>& shared_mesh() const { return clean_; }
  const RootScale& root() const { return root_; }
  std::vector<CrackSheet> partial;  // cracks that stopped inside

  Real diagonal();   // of the bounding box, m
  Real thickness();  // 2 volume / area, m: of a plate its thickness, of a ball two thirds of its radius
  const std::vector<std::uint32_t>& twins();
  const TriangleBvh& bvh();
  const SurfaceRecovery& recovery();
  // Built with the first call: one material a body.
  const ElasticBody& elastic(const Elastic& material, const ElasticOptions& options);
  bool has_elastic() const { return elastic_ != nullptr; }
  std::size_t elastic_bytes() const { return elastic_ ? elastic_->bytes() : 0; }
  void drop_elastic() { elastic_.reset(); }  // frees the dense operator

 private:
  std::shared_ptr<const SurfaceMesh> clean_;
  RootScale root_;
  Real diagonal_ = 0, thickness_ = 0;
  std::vector<std::uint32_t> twins_;
  std::unique_ptr<TriangleBvh> bvh_;
  std::unique_ptr<SurfaceRecovery> recovery_;
  std::unique_ptr<ElasticBody> elastic_;
};

}  // namespace sherd
