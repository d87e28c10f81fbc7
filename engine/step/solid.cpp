#include "engine/step/solid.h"

namespace sherd {

Real Solid::diagonal() {
  if (diagonal_ == 0) diagonal_ = bounding_box(*clean_).diagonal();
  return diagonal_;
}

Real Solid::thickness() {
  if (thickness_ == 0) thickness_ = 2 * signed_volume(*clean_) / surface_area(*clean_);
  return thickness_;
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
  if (!elastic_) elastic_ = std::make_unique<ElasticBody>(*clean_, material, options);
  return *elastic_;
}

}  // namespace sherd
