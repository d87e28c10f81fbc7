// The remesher at work: the current mesh, its feature lines, the input surface, and the guarded operations on them. An
// operation that would break the manifold, turn faces over, spoil them or make faces intersect changes nothing.
#pragma once
#include <optional>

#include "engine/mesh/bvh.h"
#include "engine/mesh/remesh.h"
#include "engine/mesh/remesh_lines.h"
#include "engine/mesh/remesh_tree.h"
#include "engine/mesh/resample.h"

namespace sherd {

class Remesher {
 public:
  // The last faces of `in`, from `real_faces` on, are ghosts.
  Remesher(const SurfaceMesh& in, std::size_t real_faces, EditMesh mesh, const RemeshOptions& options,
           RemeshReport& report);

  void run();
  const EditMesh& mesh() const { return mesh_; }
  const TriangleBvh& input() const { return input_bvh_; }
  // A face of the input that is still there as it was.
  bool untouched(std::uint32_t face) const;
  // Closest point of the input among faces of the same region that face the same way as n (n = 0: any way).
  std::optional<TriangleBvh::Closest> project(const Vec3& p, const Vec3& n, std::uint32_t region) const;

 private:
  // A face after an operation, in order around the vertex they share (corner 0).
  struct NewFace {
    Triangle vertex;
    std::array<Vec3, 3> corner;
    std::uint32_t face;  // the face it replaces
    bool crease;         // its edge 0-1 is a feature edge
  };
  using Patch = std::vector<NewFace>;

  // Passes (remesh_passes.cpp).
  void collapse_short();
  void split_long();
  void split_free_edge(std::uint32_t h);
  void flip_all();
  void smooth_all();
  void repair(Real angle);  // radians
  void repair_face(std::uint32_t t, Real angle);
  bool split_cap(std::uint32_t h);
  Vec3 smoothed_position(std::uint32_t v) const;
  bool smooth_line_vertex(std::uint32_t v);
  bool smooth_free_vertex(std::uint32_t v);

  // remesh_fit.cpp
  void fit_heights();
  void fit_volume();
  void shift(const std::vector<std::uint32_t>& givers, Real wanted, Real most);
  Real volume() const;
  bool may_give(std::uint32_t v) const;
  Vec3 area_around(std::uint32_t v) const;  // sum of the area vectors, m^2
  Real height_over_input(std::uint32_t t) const;
  bool may_fit(std::uint32_t v) const {
    return mesh_.out[v] != kNone && features_.role[v] == VertexRole::kFree && !locked(v);
  }

  // Guarded operations (remesh_operations.cpp).
  bool try_collapse(std::uint32_t h, bool repairing);
  bool try_split(std::uint32_t h, const Vec3& p, Real arc);
  bool try_flip(std::uint32_t h);
  // `keep`: the least part of the smallest angle around that must remain where it is poor.
  bool try_move(std::uint32_t v, const Vec3& p, Real keep = 1);

  bool may_collapse(std::uint32_t h, bool repairing) const;
  bool pinches_a_sheet(std::uint32_t h) const;
  Real edge_angle(std::uint32_t h) const;
  void ring(std::uint32_t v, Patch& patch) const;
  void collapse_patch(std::uint32_t h, Patch& before, Patch& after) const;
  bool turns_little(const Patch& before, const Patch& after, bool repairing) const;
  bool normal_agrees(const NewFace& after, const std::array<Vec3, 3>& before, bool repairing) const;
  Real worst_fold(const Patch& patch) const;
  bool clear(const Patch& after, const std::vector<std::uint32_t>& replaced);
  bool locked(std::uint32_t v) const { return v < locked_.size() && locked_[v] != 0; }
  bool locked_edge(std::uint32_t h) const { return locked(mesh_.from(h)) && locked(mesh_.to(h)); }
  // Target length at a vertex (also one about to be made) and on an edge, metres.
  Real target(std::uint32_t v) const { return v < size_.size() ? size_[v] : h_; }
  Real edge_target(std::uint32_t h) const { return 0.5 * (target(mesh_.from(h)) + target(mesh_.to(h))); }
  Real size_at(const TriangleBvh::Closest& on_input) const;
  void update_sizes();
  Real arc_on(std::uint32_t line, std::uint32_t v) const;
  Vec3 vertex_normal(std::uint32_t v) const;

  EditMesh mesh_;
  const RemeshOptions& options_;
  RemeshReport& report_;
  const std::vector<std::uint8_t>& locked_;
  const SurfaceMesh& input_;
  TriangleBvh input_bvh_;
  std::vector<std::uint32_t> input_region_;
  FeatureLines features_;
  FaceTree tree_;
  std::vector<Real> size_;  // per vertex of the working mesh; empty when h_ holds everywhere
  Real h_;
  Real merge_;  // features closer than this part of the target length are merged now; grows up to the option's
  Patch before_, after_;  // scratch
  std::vector<std::uint32_t> replaced_, near_;
};

}  // namespace sherd
