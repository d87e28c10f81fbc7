// A crack field that says how long it was asked, so that growth and stress at the fronts can be told apart.
#pragma once
#include "engine/fracture/crack_field.h"
#include "engine/step/stopwatch.h"

namespace sherd {

// Not for several threads at once.
class TimedField final : public CrackField {
 public:
  // Adds to `seconds`; both outlive the field.
  TimedField(const CrackField& field, Real& seconds) : field_(field), seconds_(seconds) {}
  void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const override {
    const Stopwatch watch(seconds_, "stress at fronts");
    field_.principal_stress(points, out);
  }
  void stress_ahead(const Vec3Column& points, const Vec3Column& headings,
                    std::vector<PrincipalStress>& out) const override {
    const Stopwatch watch(seconds_, "stress at fronts");
    field_.stress_ahead(points, headings, out);
  }

 private:
  const CrackField& field_;
  Real& seconds_;
};

}  // namespace sherd
