// Many random cracks with fixed seeds: the robustness that the design promises, as numbers (its tests T1 and T14).
#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/campaign/crack.h"

namespace sherd::campaign {

enum class FieldKind { kConstant, kRotating, kNoise };
const char* to_string(FieldKind kind);
const std::vector<FieldKind>& all_fields();

struct CampaignOptions {
  std::vector<FieldKind> fields = all_fields();
  std::size_t first = 0, count = 200;  // jobs of each shape and field; job i is the same whatever these are
  std::uint64_t seed = 1;
  Real arrest_share = 0.2;          // of jobs whose stress decays within 1 to 4 h of the seed
  Real rotation = 2;                // rad per diagonal
  Real noise = 0.3;                 // amplitude of each of three waves
  Real noise_wavelength = 8;        // in h
  Real thickness = 1e-3;            // of the diagonal
  Real overshoot = 0.15;            // of h
  Real edge = 1;                    // of the sheet, in mean edges of the body
  Real min_fragment_volume = 1e-5;  // of the body's; smaller is dust
  Real sign = 1;                    // of all eigenvectors
};

struct JobResult {
  std::size_t index = 0;
  FieldKind field = FieldKind::kConstant;
  std::uint32_t vertex = 0;
  int rejected = 0;  // seeds tried in vain before this one
  bool arrest = false;
  CrackReport report;
};

// Cracks of one class: how many, and the sum of their mean angles to the field, rad.
struct Fidelity {
  std::size_t cracks = 0;
  Real angles = 0;
  Real mean_degrees() const;
};

// Sums over jobs of one shape, and of one field or all.
struct Tally {
  std::string shape, field;
  std::size_t faces = 0, jobs = 0, separated = 0, pierced = 0, arrested = 0, dropped = 0, rejected = 0;
  std::size_t level[5] = {};                             // jobs that ended on each rung, dropped ones not counted
  Fidelity straight, retreated, ladder;                  // level 0 at once, level 0 after retreats, higher levels
  std::size_t invalid = 0, body_changed = 0, hangs = 0;  // hang: longer than 10 s apart from the checks
  std::size_t sheet_triangles = 0, stress_points = 0, jitters = 0;
  Real grow_s = 0, cut_s = 0, max_s = 0;
  Real worst_balance = 0;
  std::uint64_t hash = 0;

  Real true_field_share() const { return jobs ? static_cast<Real>(level[0]) / static_cast<Real>(jobs) : 1; }
  // The same without those whose front went back to steer from farther away.
  Real straight_share() const { return jobs ? static_cast<Real>(straight.cracks) / static_cast<Real>(jobs) : 1; }
  Real dropped_share() const { return jobs ? static_cast<Real>(dropped) / static_cast<Real>(jobs) : 0; }
};

struct ShapeResult {
  std::vector<JobResult> jobs;  // field by field
  std::vector<Tally> fields;
  Tally all;
};

// One job: draws field, seed vertex and arrest from (options.seed, shape, field, index); seeds that open no crack are
// drawn again, at most 50 times.
JobResult run_job(const Specimen& specimen, FieldKind field, std::size_t index, const CampaignOptions& options,
                  Crack* crack = nullptr);
// Jobs in parallel; results, and so the hashes, do not depend on the number of threads.
ShapeResult run_shape(const Specimen& specimen, const CampaignOptions& options);

std::string table_header();
std::string table_row(const Tally& tally);
nlohmann::json to_json(const ShapeResult& result);

}  // namespace sherd::campaign
