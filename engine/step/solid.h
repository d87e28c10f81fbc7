// What the fracture of a body needs besides its motion: the mesh the stress is solved on, cracks that stopped inside
// it, and the parts that depend on the mesh alone, built when first asked for and kept as long as the mesh lives.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "engine/body/mass.h"
#include "engine/fracture/sheet.h"
#include "engine/load/tension_bound.h"
#include "engine/stress/stress.h"

namespace sherd {

// Lengths that all fragments of a scene body share.
struct RootScale {
  Real edge_length = 0;         // target edge h, m
  Real volume = 0;              // of the scene body, m^3
  Real diagonal = 0;            // of its bounding box, m
  Real edge_per_thickness = 0;  // of the scene body
};

struct StoppedCrack {
  CrackSheet sheet;
  std::int32_t id = 0;            // of the crack's record
  std::vector<std::int32_t> met;  // stopped cracks it ran into, where it waits for them to go through
};

// What a Solid is beside its mesh and lengths: not to be found from the mesh alone, so part of a checkpoint. A member
// added here is kept; what Solid itself builds must follow from the mesh and these.
struct SolidState {
  std::vector<StoppedCrack> partial;  // cracks that stopped inside
  bool coarse_space = false;          // solves of this mesh need one, as an earlier solve found
  SolutionHistory history;            // of solves of this mesh, where the next ones start from
  bool assembled = false;             // its system was, be it kept or not
};

// A crack that stopped inside is kept as a sheet beside the *clean* mesh (without its notch): the stress is solved on
// the clean mesh and the sheet grows on from it later (design O13). The two walls of a notch lie a thousandth of an
// edge apart, and a displacement formulation degenerates there; so a stopped crack is seen and resumes at the lower
// propagation strength, but does not redistribute stress before it goes through.
class Solid : public SolidState {
 public:
  // `edge_length`: of the mesh and of cracks in it, m; 0: the root's.
  Solid(std::shared_ptr<const SurfaceMesh> clean, const RootScale& root, Real edge_length = 0)
      : clean_(std::move(clean)), root_(root), edge_length_(edge_length > 0 ? edge_length : root.edge_length) {}

  const SurfaceMesh& mesh() const { return *clean_; }
  const std::shared_ptr<const SurfaceMesh>& shared_mesh() const { return clean_; }
  const RootScale& root() const { return root_; }
  Real edge_length() const { return edge_length_; }

  Real mesh_volume();  // m^3
  Real diagonal();     // of the bounding box, m
  // Of its thinnest parts, m: twice volume over area (of a plate its thickness, of a ball two thirds of its radius), or
  // the wall all but a hundredth of its surface is thicker than.
  Real thickness();
  BoundedBody bounded();  // as tension_bound() sees it
  // Edge length that puts several rows of a crack's sheet between the two sides of the wall near x, m: the mesh's, or a
  // shorter one.
  Real crack_edge_length(const Vec3& x);
  const std::vector<std::uint32_t>& twins();
  const TriangleBvh& bvh();
  const SurfaceRecovery& recovery();
  // Built with the first call: one material a body.
  const ElasticBody& elastic(const Elastic& material, const ElasticOptions& options);
  bool has_elastic() const { return elastic_ != nullptr; }
  std::size_t elastic_bytes() const { return elastic_ ? elastic_->bytes() : 0; }
  // After solves, and before the operator goes: what they taught.
  void learn() { coarse_space = coarse_space || (elastic_ && elastic_->needs_coarse_space()); }
  void drop_elastic() { learn(), elastic_.reset(); }  // frees the dense operator

 private:
  std::shared_ptr<const SurfaceMesh> clean_;
  RootScale root_;
  Real edge_length_ = 0;
  Real volume_ = 0, diagonal_ = 0, thickness_ = 0;
  std::vector<Real> walls_;  // thickness at vertices
  std::optional<bool> notched_;
  std::vector<std::uint32_t> twins_;
  std::unique_ptr<TriangleBvh> bvh_;
  std::unique_ptr<SurfaceRecovery> recovery_;
  std::unique_ptr<ElasticBody> elastic_;
};

}  // namespace sherd
