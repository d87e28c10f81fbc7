#include "tools/campaign/campaign.h"

#include <cmath>
#include <numbers>

#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "tools/campaign/hash.h"

namespace sherd::campaign {
namespace {

constexpr int kMaxDraws = 50;
constexpr Real kHang = 10;  // s

Vec3 random_direction(Random& random) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = random.uniform(-1, 1);
  return normalized(v);
}

FunctionField::Function random_field(const Specimen& s, FieldKind kind, const CampaignOptions& o, Random& random) {
  const Vec3 e = random_direction(random);
  if (kind == FieldKind::kConstant) return constant_direction(e);
  if (kind == FieldKind::kNoise) return noisy_direction(e, o.noise, o.noise_wavelength * s.h, random.next());
  const Vec3 axis = random_direction(random), along = random_direction(random);
  return rotating_direction(e, axis, along, o.rotation / s.diagonal);
}

Random random_of(const Specimen& s, FieldKind kind, std::size_t index, std::uint64_t seed) {
  Hash hash;
  hash.add_bytes(s.name.data(), s.name.size());
  hash.add_number(static_cast<std::uint64_t>(kind)), hash.add_number(index), hash.add_number(seed);
  return Random(hash.value());
}

void count(const JobResult& job, Tally& t) {
  const CrackReport& r = job.report;
  t.rejected += static_cast<std::size_t>(job.rejected);
  t.invalid += !r.invalid.empty(), t.body_changed += r.body_changed;
  Hash hash;
  hash.add_number(t.hash), hash.add_number(r.hash);
  t.hash = hash.value();
  if (r.outcome == CrackOutcome::kRejected) return;
  ++t.jobs;
  t.separated += r.outcome == CrackOutcome::kSeparated, t.pierced += r.outcome == CrackOutcome::kPierced;
  t.arrested += r.outcome == CrackOutcome::kArrested, t.dropped += r.outcome == CrackOutcome::kDropped;
  if (r.outcome != CrackOutcome::kDropped) {
    ++t.level[r.level];
    Fidelity& class_ = r.level > 0 ? t.ladder : r.retreats > 0 ? t.retreated : t.straight;
    ++class_.cracks, class_.angles += r.angle;
  }
  t.hangs += r.grow_s + r.cut_s > kHang;
  t.sheet_triangles += r.sheet_triangles, t.stress_points += r.stress_points;
  t.jitters += static_cast<std::size_t>(r.jitters);
  t.grow_s += r.grow_s, t.cut_s += r.cut_s, t.max_s = std::max(t.max_s, r.grow_s + r.cut_s);
  t.worst_balance = std::max(t.worst_balance, r.balance);
}

}  // namespace

Real Fidelity::mean_degrees() const {
  return cracks ? angles / static_cast<Real>(cracks) * 180 / std::numbers::pi : 0;
}

const char* to_string(FieldKind kind) {
  switch (kind) {
    case FieldKind::kConstant:
      return "constant";
    case FieldKind::kRotating:
      return "rotating";
    case FieldKind::kNoise:
      return "noise";
  }
  return "";
}

const std::vector<FieldKind>& all_fields() {
  static const std::vector<FieldKind> all{FieldKind::kConstant, FieldKind::kRotating, FieldKind::kNoise};
  return all;
}

JobResult run_job(const Specimen& s, FieldKind kind, std::size_t index, const CampaignOptions& o, Crack* out) {
  Random random = random_of(s, kind, index, o.seed);
  JobResult job;
  job.index = index, job.field = kind;
  GrowthOptions growth = s.options();
  growth.edge_length *= o.edge, growth.overshoot = o.overshoot, growth.thickness = o.thickness * s.diagonal;
  for (int draw = 0; draw < kMaxDraws; ++draw) {
    const auto base = random_field(s, kind, o, random);
    job.vertex = static_cast<std::uint32_t>(random.uniform() * static_cast<double>(s.mesh().vertex_count()));
    job.arrest = random.uniform() < o.arrest_share;
    const Real reach = random.uniform(1, 4) * s.h;
    const Vec3 origin = s.mesh().vertices[job.vertex];
    const FunctionField field(
        [&](const Vec3& p) {
          PrincipalStress stress = base(p);
          if (job.arrest) stress.value = std::exp2(-distance(p, origin) / reach);
          return stress;
        },
        o.sign);
    Crack crack = run_crack(s, field, s.seed_at(job.vertex, field), growth, o.min_fragment_volume);
    job.report = crack.report;
    if (out) *out = std::move(crack);
    if (job.report.outcome != CrackOutcome::kRejected || !job.report.invalid.empty()) return job;
    ++job.rejected;
  }
  return job;
}

ShapeResult run_shape(const Specimen& s, const CampaignOptions& o) {
  ShapeResult result;
  result.jobs.resize(o.fields.size() * o.count);
  parallel_for(result.jobs.size(), 1,
               [&](std::size_t i) { result.jobs[i] = run_job(s, o.fields[i / o.count], o.first + i % o.count, o); });
  result.all.shape = s.name, result.all.field = "all", result.all.faces = s.mesh().triangle_count();
  for (std::size_t f = 0; f < o.fields.size(); ++f) {
    Tally tally;
    tally.shape = s.name, tally.field = to_string(o.fields[f]), tally.faces = s.mesh().triangle_count();
    for (std::size_t i = 0; i < o.count; ++i) {
      count(result.jobs[f * o.count + i], tally);
      count(result.jobs[f * o.count + i], result.all);
    }
    result.fields.push_back(tally);
  }
  return result;
}

}  // namespace sherd::campaign
