#include "engine/fracture/grow_many.h"

#include <algorithm>
#include <numeric>

#include "engine/fracture/attempt.h"
#include "engine/fracture/seed.h"

namespace sherd {
namespace {

// Strongest first; by place where equal, so that the order given means nothing.
bool is_stronger(const CrackSeed& a, const CrackSeed& b) {
  if (a.stress.value != b.stress.value) return a.stress.value > b.stress.value;
  const Vec3 &p = a.position, &q = b.position;
  return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
}

class Race {
 public:
  Race(const TriangleBvh& body, const CrackField& field, std::span<const CrackSeed> seeds, const GrowthOptions& options)
      : body_(body),
        field_(field),
        seeds_(seeds),
        options_(options),
        attempts_(seeds.size()),
        running_(seeds.size(), false),
        results_(seeds.size()) {
    order_.resize(seeds.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return is_stronger(seeds_[a], seeds_[b]); });
  }

  std::vector<GrowthResult> run() {
    for (const std::size_t i : order_) open(i);
    for (const std::size_t i : order_) introduce(i);
    for (bool running = true; running;) {
      running = false;
      for (const std::size_t i : order_) running |= advance(i);
    }
    for (const std::size_t i : order_)
      if (results_[i].outcome == GrowthOutcome::kFailed) retry(i);
    return std::move(results_);
  }

 private:
  void open(std::size_t i) {
    for (const std::size_t k : order_) {
      if (k == i) break;
      if (attempts_[k] && distance(seeds_[k].position, seeds_[i].position) < 2 * options_.edge_length) {
        reject(i, "a stronger seed is nearer than two edge lengths");
        return;
      }
    }
    auto attempt = std::make_unique<Attempt>(body_, field_, options_, 0);
    if (std::string refusal = open_seed(attempt->growth(), seeds_[i]); !refusal.empty())
      reject(i, refusal);
    else
      attempts_[i] = std::move(attempt), running_[i] = true;
  }

  void reject(std::size_t i, const std::string& reason) {
    results_[i].outcome = GrowthOutcome::kRejectedSeed;
    results_[i].reason = results_[i].rungs.reason[0] = reason;
  }

  void introduce(std::size_t i) {
    if (!attempts_[i]) return;
    bool stronger = true;
    for (const std::size_t k : order_)
      if (k == i)
        stronger = false;
      else if (attempts_[k])
        attempts_[i]->growth().rivals.push_back(
            {&attempts_[k]->growth().sheet, static_cast<std::int32_t>(k), stronger});
  }

  // One step of crack i; false when it has ended.
  bool advance(std::size_t i) {
    if (!running_[i] || attempts_[i]->step()) return running_[i];
    results_[i] = attempts_[i]->finish();
    if (results_[i].outcome == GrowthOutcome::kFailed) {
      if (attempts_[i]->retreat()) return true;
      attempts_[i]->growth().sheet = SheetMesh(options_.edge_length, 0);  // nobody's obstacle any more
    }
    return running_[i] = false;
  }

  // The rest of the ladder, among what the others have become.
  void retry(std::size_t i) {
    Obstacles all = options_.obstacles ? *options_.obstacles : Obstacles();
    for (std::size_t k = 0; k < results_.size(); ++k)
      if (k != i && !results_[k].sheet.triangles.empty())
        all.add_sheet(static_cast<std::int32_t>(k), results_[k].sheet);
    GrowthOptions options = options_;
    options.obstacles = &all;
    results_[i] = grow_crack(body_, field_, seeds_[i], options);
  }

  const TriangleBvh& body_;
  const CrackField& field_;
  std::span<const CrackSeed> seeds_;
  const GrowthOptions& options_;
  std::vector<std::unique_ptr<Attempt>> attempts_;  // null: rejected
  std::vector<bool> running_;
  std::vector<GrowthResult> results_;
  std::vector<std::size_t> order_;
};

}  // namespace

std::vector<GrowthResult> grow_cracks(const TriangleBvh& body, const CrackField& field,
                                      std::span<const CrackSeed> seeds, const GrowthOptions& options) {
  if (const std::string bad = check_options(body, options); !bad.empty()) {
    GrowthResult failed;
    failed.reason = bad;
    return std::vector<GrowthResult>(seeds.size(), failed);
  }
  return Race(body, field, seeds, options).run();
}

}  // namespace sherd
