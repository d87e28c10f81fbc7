#include "engine/step/solid.h"

#include <algorithm>

#include "engine/mesh/thickness.h"
#include "engine/mesh/thickness_resolution.h"

namespace sherd {

Real Solid::mesh_volume() {
  if (volume_ == 0) volume_ = signed_volume(*clean_);
  return volume_;
}

Real Solid::diagonal() {
  if (diagonal_ == 0) diagonal_ = bounding_box(*clean_).diagonal();
  return diagonal_;
}

Real Solid::thickness() {
  if (thickness_ == 0) {
    thickness_ = 2 * mesh_volume() / surface_area(*clean_);
    const Real wall = resolution_report(*clean_).governing;
    if (wall > 0) thickness_ = std::min(thickness_, wall);
  }
  return thickness_;
}

BoundedBody Solid::bounded() {
  if (!notched_) notched_ = has_reentrant_creases(*clean_, twins());
  return {thickness(), diagonal(), *notched_};
}

Real Solid::crack_edge_length(const Vec3& x) {
  constexpr Real kPerWall = 0.4, kFinest = 0.25, kReach = 1.5;  // of the wall, of the mesh's edge, edges around x
  if (walls_.empty()) walls_ = wall_thickness(*clean_).vertex;
  Real wall = 1e300;
  for (std::size_t v = 0; v < walls_.size(); ++v)
    if (distance2(clean_->vertices[v], x) < kReach * kReach * edge_length_ * edge_length_)
      wall = std::min(wall, walls_[v]);
  return std::clamp(kPerWall * wall, kFinest * edge_length_, edge_length_);
}

const std::vector<std::uint32_t>& Solid::twins() {
  if (twins_.empty()) twins_ = build_twins(*clean_);
  return twins_;
}

const TriangleBvh& Solid::bvh() {
  if (!bvh_) bvh_ = std::make_unique<TriangleBvh>(*clean_);
  return *bvh_;
}

const SurfaceRecovery& Solid::recovery() {
  if (!recovery_) recovery_ = std::make_unique<SurfaceRecovery>(*clean_, RecoveryOptions{});
  return *recovery_;
}

const ElasticBody& Solid::elastic(const Elastic& material, const ElasticOptions& options) {
  if (!elastic_) {
    ElasticOptions o = options;
    o.coarse_space = coarse_space;
    elastic_ = std::make_unique<ElasticBody>(*clean_, material, o);
  }
  return *elastic_;
}

}  // namespace sherd
