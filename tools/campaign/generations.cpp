#include "tools/campaign/generations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/mesh/certificate.h"
#include "engine/mesh/refit.h"
#include "engine/step/stopwatch.h"
#include "kernels/core/parallel.h"
#include "kernels/core/random.h"
#include "tools/campaign/campaign.h"
#include "tools/campaign/solvable.h"

namespace sherd::campaign {
namespace {

constexpr int kSeedDraws = 20;    // for one crack of a piece
constexpr Real kEdgesAcross = 4;  // of a piece, at least: its edge is at most this part of the volume's cube root

struct Part {
  SurfaceMesh mesh;
  Real volume = 0, edge = 0;
};

// What came of one piece in one generation.
struct Breakage {
  std::vector<Part> parts;
  GenerationRow row;
  Real crack_volume = 0, removed = 0, dust = 0;  // m^3
  std::vector<std::string> defects;
};

Real edge_of(Real volume, Real root_edge) {
  return std::min(root_edge, std::cbrt(volume) / kEdgesAcross);
}

class Breaker {
 public:
  Breaker(const Specimen& root, const GenerationOptions& options, int generation)
      : root_(root), options_(options), generation_(generation) {}
  Breakage operator()(const SurfaceMesh& piece, std::uint64_t seed) const;

 private:
  bool crack_largest(Breakage& b, Random& random) const;
  void refit_part(Part& part, Breakage& b) const;

  const Specimen& root_;
  const GenerationOptions& options_;
  int generation_;
};

// Draws seeds until one opens a crack that goes through; false when none did. Cracks of a generation never stop inside.
bool Breaker::crack_largest(Breakage& b, Random& random) const {
  const auto largest = std::max_element(b.parts.begin(), b.parts.end(),
                                        [](const Part& p, const Part& q) { return p.volume < q.volume; });
  const Specimen body(fmt::format("{} {}", root_.name, random.next()), largest->mesh);
  CampaignOptions o;
  o.arrest_share = 0, o.seed = random.next();
  o.edge = largest->edge / body.h, o.thickness = options_.thickness * root_.diagonal / body.diagonal;
  o.min_fragment_volume = options_.min_fragment_volume * root_.body.volume() / body.body.volume();
  for (std::size_t draw = 0; draw < kSeedDraws; ++draw) {
    Crack crack;
    const FieldKind field = all_fields()[draw % all_fields().size()];
    const CrackReport& r = run_job(body, field, draw, o, &crack).report;
    if (r.outcome == CrackOutcome::kRejected) continue;
    ++b.row.cracks;
    b.row.dropped += r.outcome == CrackOutcome::kDropped;
    b.row.invalid += !r.invalid.empty();
    if (!r.invalid.empty()) b.defects.push_back("crack: " + r.invalid);
    if (r.outcome == CrackOutcome::kDropped) continue;
    b.row.true_field += r.level == 0;
    if (!r.invalid.empty() || r.outcome != CrackOutcome::kSeparated || crack.cut.fragments.size() < 2) continue;
    b.crack_volume += options_.thickness * root_.diagonal * r.area;
    b.removed += crack.cut.removed_volume, b.dust += crack.cut.dust_volume;
    const Real edge = largest->edge;
    b.parts.erase(largest);
    for (SurfaceMesh& f : crack.cut.fragments) {
      const Real volume = signed_volume(f);
      b.parts.push_back({std::move(f), volume, edge});
    }
    return true;
  }
  return false;
}

void Breaker::refit_part(Part& part, Breakage& b) const {
  part.edge = edge_of(part.volume, root_.h);
  SurfaceMesh fitted;
  const RefitReport r =
      refit(part.mesh, {.edge_length = part.edge, .edge_per_thickness = options_.edge_per_thickness}, fitted);
  if (!r.ok) {
    ++b.row.refit_refused;
    b.defects.push_back("refit: " + r.reason);
    return;
  }
  b.row.graded += r.wall_passes > 0;
  const Real volume = signed_volume(fitted);
  b.row.refit_volume_change += std::abs(volume - part.volume);
  part.mesh = std::move(fitted), part.volume = volume;
}

void certify_part(const Part& part, Breakage& b) {
  const MeshCertificate c = certify(part.mesh);
  ++b.row.pieces;
  b.row.certified += c.ok();
  if (!c.ok()) b.defects.push_back("piece: " + c.first_defect);
  b.row.below_1_degree += c.below_1_degree, b.row.below_15_degrees += c.below_15_degrees;
  b.row.triangles += c.triangles, b.row.min_angle = std::min(b.row.min_angle, c.min_angle);
}

Breakage Breaker::operator()(const SurfaceMesh& piece, std::uint64_t seed) const {
  Random random(seed);
  Breakage b;
  b.row.generation = generation_, b.row.min_angle = 180;
  const Real volume = signed_volume(piece);
  b.parts.push_back({piece, volume, edge_of(volume, root_.h)});
  int made = 0;
  while (made < options_.cracks_per_piece && crack_largest(b, random)) ++made;
  if (made == 0) ++b.row.unbroken;
  for (Part& part : b.parts) {
    if (made > 0) refit_part(part, b);
    certify_part(part, b);
  }
  return b;
}

void add(const GenerationRow& from, GenerationRow& to) {
  to.pieces += from.pieces, to.cracks += from.cracks, to.true_field += from.true_field, to.dropped += from.dropped;
  to.unbroken += from.unbroken, to.invalid += from.invalid, to.refit_refused += from.refit_refused,
      to.graded += from.graded;
  to.certified += from.certified, to.below_1_degree += from.below_1_degree;
  to.below_15_degrees += from.below_15_degrees, to.triangles += from.triangles;
  to.min_angle = std::min(to.min_angle, from.min_angle), to.refit_volume_change += from.refit_volume_change;
}

void solve_all(const GenerationOptions& options, GenerationResult& result) {
  std::vector<Solvability> answers(result.pieces.size());
  parallel_for(answers.size(), 1, [&](std::size_t i) { answers[i] = solve_piece(result.pieces[i], options.seed + i); });
  for (const Solvability& a : answers) {
    result.solvable += a.clean(), result.warned += !a.clean();
    result.warnings.insert(result.warnings.end(), a.warnings.begin(), a.warnings.end());
  }
}

}  // namespace

GenerationResult run_generations(const Specimen& body, const GenerationOptions& options) {
  GenerationResult result;
  result.shape = body.name;
  const Stopwatch watch(result.seconds, "generations");
  result.pieces.push_back(body.mesh());
  const Real root = body.body.volume();
  Real crack_volume = 0, removed = 0;
  Random random(options.seed);
  for (int g = 1; g <= options.most_generations; ++g) {
    if (g > options.least_generations && result.pieces.size() >= options.least_pieces) break;
    const Breaker breaker(body, options, g);
    std::vector<std::uint64_t> seeds(result.pieces.size());
    for (std::uint64_t& s : seeds) s = random.next();
    std::vector<Breakage> broken(result.pieces.size());
    parallel_for(broken.size(), 1, [&](std::size_t i) { broken[i] = breaker(result.pieces[i], seeds[i]); });
    result.pieces.clear();
    GenerationRow row;
    row.generation = g, row.min_angle = 180;
    for (Breakage& b : broken) {
      add(b.row, row);
      crack_volume += b.crack_volume, removed += b.removed, result.dust_volume += b.dust / root;
      for (Part& p : b.parts) result.pieces.push_back(std::move(p.mesh));
      result.warnings.insert(result.warnings.end(), b.defects.begin(), b.defects.end());
    }
    row.refit_volume_change /= root;
    result.rows.push_back(row);
  }
  Real volume = crack_volume;
  for (const SurfaceMesh& p : result.pieces) volume += signed_volume(p);
  result.volume_error = std::abs(1 - volume / root - result.dust_volume);
  result.removed_error = removed > 0 ? std::abs(removed - crack_volume) / removed : 0;
  if (options.solve) solve_all(options, result);
  return result;
}

std::string generation_header() {
  return fmt::format("{:<12} {:>3} {:>6} {:>6} {:>7} {:>4} {:>7} {:>8} {:>7} {:>6} {:>9} {:>5} {:>6} {:>7} {:>9} {:>9}",
                     "shape", "gen", "pieces", "cracks", "level 0", "drop", "invalid", "unbroken", "refused", "graded",
                     "certified", "< 1", "< 15", "min deg", "triangles", "volume");
}

std::string to_text(const GenerationResult& result) {
  std::string text;
  for (const GenerationRow& r : result.rows)
    text += fmt::format(
        "{:<12} {:>3} {:>6} {:>6} {:>7} {:>4} {:>7} {:>8} {:>7} {:>6} {:>9} {:>5} {:>6} {:>7.2f} {:>9} {:>9.2e}\n",
        result.shape, r.generation, r.pieces, r.cracks, r.true_field, r.dropped, r.invalid, r.unbroken, r.refit_refused,
        r.graded, r.certified, r.below_1_degree, r.below_15_degrees, r.min_angle, r.triangles, r.refit_volume_change);
  return text + fmt::format(
                    "{:<12} volume sum off by {:.2e}, removed volume against thickness x area {:.2e}, dust {:.2e}; "
                    "{} of {} pieces solved without a warning; {:.1f} s\n",
                    result.shape, result.volume_error, result.removed_error, result.dust_volume, result.solvable,
                    result.pieces.size(), result.seconds);
}

nlohmann::json to_json(const GenerationResult& result) {
  nlohmann::json rows = nlohmann::json::array();
  for (const GenerationRow& r : result.rows)
    rows.push_back({{"generation", r.generation},
                    {"pieces", r.pieces},
                    {"cracks", r.cracks},
                    {"true_field", r.true_field},
                    {"dropped", r.dropped},
                    {"unbroken", r.unbroken},
                    {"invalid", r.invalid},
                    {"refit_refused", r.refit_refused},
                    {"graded", r.graded},
                    {"certified", r.certified},
                    {"below_1_degree", r.below_1_degree},
                    {"below_15_degrees", r.below_15_degrees},
                    {"min_angle", r.min_angle},
                    {"triangles", r.triangles},
                    {"refit_volume_change", r.refit_volume_change}});
  return {{"shape", result.shape},
          {"generations", rows},
          {"pieces", result.pieces.size()},
          {"solvable", result.solvable},
          {"warned", result.warned},
          {"dust_volume", result.dust_volume},
          {"volume_error", result.volume_error},
          {"removed_error", result.removed_error},
          {"warnings", result.warnings},
          {"seconds", result.seconds}};
}

}  // namespace sherd::campaign
