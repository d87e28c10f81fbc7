#include "engine/material/attribute_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/mesh/bvh.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

// Weights of the corners of a triangle at a point of its plane, by areas; equal ones for a triangle without area.
std::array<Real, 3> barycentric(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const Real whole = norm2(n);
  if (!(whole > 0)) return {1.0 / 3, 1.0 / 3, 1.0 / 3};
  const Real b = dot(cross(p - t[0], t[2] - t[0]), n) / whole, c = dot(cross(t[1] - t[0], p - t[0]), n) / whole;
  return {1 - b - c, b, c};
}

class AttributeField final : public ScalarField {
 public:
  AttributeField(const AttributeSpec& spec, const SurfaceMesh& mesh, const CornerChannel& channel)
      : low_(spec.low), high_(spec.high), bvh_(mesh) {
    for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
      const Real value = channel.value[corner * static_cast<std::size_t>(channel.components)];
      share_.push_back(std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0);
    }
  }
  Real at(const Vec3& x) const override {
    const TriangleBvh::Closest c = bvh_.closest(x);
    if (c.face == kNone) return low_;
    const std::array<Real, 3> weight = barycentric(bvh_.corners(c.face), c.point);
    Real share = 0;
    for (std::size_t k = 0; k < 3; ++k) share += weight[k] * share_[3 * c.face + k];
    return std::lerp(low_, high_, std::clamp(share, 0.0, 1.0));
  }
  Real lower() const override { return std::min(low_, high_); }
  Real upper() const override { return std::max(low_, high_); }

 private:
  Real low_, high_;
  TriangleBvh bvh_;
  std::vector<Real> share_;  // per corner, 0 .. 1
};

}  // namespace

ScalarFieldPtr attribute_field(const AttributeSpec& spec, const SurfaceMesh& mesh) {
  std::string names;
  for (const CornerChannel& channel : mesh.channels) {
    if (channel.name == spec.name) return std::make_shared<AttributeField>(spec, mesh, channel);
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", channel.name);
  }
  throw InputError(fmt::format("the mesh has no vertex attribute \"{}\"; {}", spec.name,
                               names.empty()
                                   ? "it has none: save it as PLY with a float property of that name at each vertex"
                                   : fmt::format("it has {}", names)));
}

}  // namespace sherd
