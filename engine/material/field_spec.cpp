#include "engine/material/field_spec.h"

#include <algorithm>
#include <cmath>

#include "engine/material/attribute_field.h"
#include "engine/material/grain_field.h"
#include "engine/material/noise_field.h"
#include "kernels/core/error.h"
#include "kernels/core/overload.h"

namespace sherd {
namespace {

class LayerField final : public ScalarField {
 public:
  explicit LayerField(LayerSpec spec) : spec_(std::move(spec)), bounds_(bounds_of(spec_, {})) {}
  Real at(const Vec3& x) const override {
    const Real place = dot(x, spec_.axis), half = 0.5 * spec_.blend;
    // The first layer whose end, transition included, lies beyond the place.
    const auto end = std::partition_point(spec_.offsets.begin(), spec_.offsets.end(),
                                          [&](Real offset) { return offset + half <= place; });
    const auto i = static_cast<std::size_t>(end - spec_.offsets.begin());
    if (end == spec_.offsets.end() || place < *end - half) return spec_.values[i];
    return std::lerp(spec_.values[i], spec_.values[i + 1], (place - (*end - half)) / spec_.blend);
  }
  Real lower() const override { return bounds_.lower; }
  Real upper() const override { return bounds_.upper; }

 private:
  LayerSpec spec_;
  FieldBounds bounds_;
};

class ShareField final : public ScalarField {
 public:
  ShareField(ScalarFieldPtr whole, Real factor) : whole_(std::move(whole)), factor_(factor) {}
  Real at(const Vec3& x) const override { return factor_ * whole_->at(x); }
  Real lower() const override { return factor_ * whole_->lower(); }
  Real upper() const override { return factor_ * whole_->upper(); }

 private:
  ScalarFieldPtr whole_;
  Real factor_;
};

class LesserField final : public ScalarField {
 public:
  LesserField(ScalarFieldPtr a, ScalarFieldPtr b) : a_(std::move(a)), b_(std::move(b)) {}
  Real at(const Vec3& x) const override { return std::min(a_->at(x), b_->at(x)); }
  Real lower() const override { return std::min(a_->lower(), b_->lower()); }
  Real upper() const override { return std::min(a_->upper(), b_->upper()); }

 private:
  ScalarFieldPtr a_, b_;
};

}  // namespace

FieldBounds bounds_of(const FieldSpec& spec, const FieldBounds& whole) {
  return std::visit(Overload{
                        [](const ConstantSpec& s) {
                          return FieldBounds{s.value, s.value};
                        },
                        [](const NoiseSpec& s) {
                          const Real a = s.amplitude;
                          return s.lognormal ? FieldBounds{s.mean * std::exp(-a), s.mean * std::exp(a)}
                                             : FieldBounds{s.mean * (1 - a), s.mean * (1 + a)};
                        },
                        [](const LayerSpec& s) {
                          const auto [low, high] = std::minmax_element(s.values.begin(), s.values.end());
                          return FieldBounds{*low, *high};
                        },
                        [](const GrainSpec& s) {
                          return FieldBounds{s.mean * (1 - s.spread) * std::min(s.boundary, 1.0),
                                             s.mean * (1 + s.spread) * std::max(s.boundary, 1.0)};
                        },
                        [](const AttributeSpec& s) {
                          return FieldBounds{std::min(s.low, s.high), std::max(s.low, s.high)};
                        },
                        [&](const ShareSpec& s) {
                          return FieldBounds{s.factor * whole.lower, s.factor * whole.upper};
                        },
                    },
                    spec);
}

ScalarFieldPtr make_field(const FieldSpec& spec, const SurfaceMesh& mesh, const ScalarFieldPtr& whole) {
  return std::visit(Overload{
                        [](const ConstantSpec& s) { return constant_field(s.value); },
                        [](const NoiseSpec& s) -> ScalarFieldPtr { return std::make_shared<NoiseField>(s); },
                        [](const LayerSpec& s) -> ScalarFieldPtr { return std::make_shared<LayerField>(s); },
                        [](const GrainSpec& s) -> ScalarFieldPtr { return std::make_shared<GrainField>(s); },
                        [&](const AttributeSpec& s) -> ScalarFieldPtr { return attribute_field(s, mesh); },
                        [&](const ShareSpec& s) -> ScalarFieldPtr {
                          SHERD_CHECK(whole != nullptr, "a share of no field");
                          return std::make_shared<ShareField>(whole, s.factor);
                        },
                    },
                    spec);
}

ScalarFieldPtr lesser_field(ScalarFieldPtr a, ScalarFieldPtr b) {
  if (a->upper() <= b->lower()) return a;
  return std::make_shared<LesserField>(std::move(a), std::move(b));
}

}  // namespace sherd
