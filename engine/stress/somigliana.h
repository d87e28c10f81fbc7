// Somigliana's identity differentiated: the displacement gradient of a solved body at many points. Three sources a
// panel, summed directly or by the fast multipole method, corrected where a panel is nearer than they allow.
#pragma once
#include <span>

#include "engine/elastostatic/panel_search.h"
#include "engine/stress/element_field.h"
#include "engine/stress/lane_gradients.h"

namespace sherd {

class Somigliana {
 public:
  enum class FarSum : std::uint8_t { kAutomatic, kDirect, kFast };

  // Keeps references to both.
  Somigliana(const Boundary& boundary, const std::vector<ElementField>& elements, const Elastic& material,
             const QuadratureOptions& options);
  // face[k]: the triangle point k lies on, for the limit from inside, or kNone. [i][k] = u_i,k. Automatic: fast from so
  // many pairs on that its trees are paid for. Parallel; the same bits for any number of threads.
  void gradients(const Vec3Column& x, std::span<const std::uint32_t> face, std::span<Mat3> out,
                 FarSum sum = FarSum::kAutomatic) const;

 private:
  void direct_sum(const LaneTargets& targets, std::size_t chunk, LaneGradients& sum) const;
  void fast_sums(const Vec3Column& x, std::span<Mat3> out) const;
  // What panels nearby add to the sums, of which they left out sources whose squared distance is not above `least`.
  Mat3 correction(const Vec3& x, std::uint32_t face, Real least) const;
  // Points so near a source that sums which take it out again lose digits.
  bool touches_source(const Vec3& x) const;

  const Boundary& boundary_;
  const std::vector<ElementField>& elements_;
  Elastic material_;
  Vec3Column position_, density_, guenter_, normal_;
  std::array<std::vector<Real>, 9> gradient_;
  std::vector<Real> near2_, middle2_;  // squared reach of the closed form and of seven points, m^2
  Real least2_ = 1e300;                // a point this near a source is that source, m^2
  PanelSearch search_;
};

}  // namespace sherd
