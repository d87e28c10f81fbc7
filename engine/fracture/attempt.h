// One rung of the ladder (O8): a growth from its start to its end, step by step, so that several cracks can take turns.
// Internal to the fracture stage.
#pragma once
#include <optional>
#include <tuple>

#include "engine/fracture/front.h"

namespace sherd {

class Attempt {
 public:
  // level: the rung, 0 .. kRungCount - 1. The sheet is empty: open_seed() or open_sheet() lays the first one.
  Attempt(const TriangleBvh& body, const CrackField& field, const GrowthOptions& options, int level);

  Growth& growth() { return growth_; }
  // Labels the front and moves it on. Returns false when growth has ended, for whatever reason.
  bool step();
  // After a failure: closes rings whose arms missed each other, else takes back the last steps before they did, to let
  // them steer from farther away. Returns false when that was tried often enough.
  bool retreat();
  // The outcome and, when the growth did not fail, the sheet with all its tests passed.
  GrowthResult finish();

 private:
  void judge(GrowthResult& result) const;
  std::vector<std::int32_t> cracks_met() const;
  bool close_ring();
  void go_on(const CrackSheet& sheet);
  std::string test(const CrackSheet& sheet) const;
  CrackSheet extract() const;

  struct Saved {
    int step;
    std::size_t wings;  // parted by then
    CrackSheet sheet;
  };

  Growth growth_;
  std::vector<Saved> history_;
  std::size_t widened_ = 0, rings_ = 0;        // retreats of either kind
  std::tuple<int, Real, int> from_{-1, 0, 0};  // step, steering range and tension of the last retreat
  int level_, steps_ = 0, limit_;
  bool ended_ = false;  // no active node is left
  bool spiral_ = false;
  std::optional<int> missed_;  // step in which a front first ran along its own sheet or into it
  std::vector<CrackSheet> wings_;
  std::shared_ptr<const CrackSheet> stopped_;
};

// Why growth with these options cannot start, or an empty string.
std::string check_options(const TriangleBvh& body, const GrowthOptions& options);
// Goes on from a stopped sheet. Returns the reason of a refusal, or an empty string.
std::string open_sheet(Growth& g, const CrackSheet& sheet);

}  // namespace sherd
