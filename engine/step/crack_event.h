// The cracks of one event: grown in the pieces that earlier ones left, cut, and at the end fit for the next solve.
// Knows nothing of how the stress was found.
#pragma once
#include <functional>
#include <memory>
#include <span>

#include "engine/fragment/cut.h"
#include "engine/step/fracture_event.h"

namespace sherd {

// Each crack either ends in valid pieces (or a valid notch) or leaves everything as it was; whatever is thrown while it
// grows, thickens or cuts drops that crack alone, and its record says why.
class CrackEvent {
 public:
  // `solid`, `options` and `result` outlive the event.
  CrackEvent(Solid& solid, const FractureOptions& options, FractureResult& result);

  // Lets the body's stopped cracks grow on. `ligaments`: those that stop again are asked whether the rest of their
  // section holds, worth its cost only under a load that could start a crack.
  void resume(const CrackField& field, bool ligaments);
  // Strongest first. A seed within two edges of a crack of this event or of a stopped one starts nothing.
  void start(const CrackField& field, std::span<const CrackSeed> seeds, CrackCause cause = CrackCause::kStress);
  // From each of the guide's seeds along it; one that leaves it by more than kOffGuide edges fails. `strength`: Pa.
  void start_along(const Guide& guide, Real strength);
  // Remeshes, cuts the notches of stopped cracks into what is shown, and leaves the shapes in the result.
  void finish();

 private:
  struct Piece {
    std::shared_ptr<const SurfaceMesh> mesh;
    std::vector<StoppedCrack> partial;
    bool was_cut = false;
    std::unique_ptr<CutBody> body;  // of `mesh`, made when first asked for

    const CutBody& cut_body() {
      if (!body) body = std::make_unique<CutBody>(*mesh);
      return *body;
    }
    const TriangleBvh& tree() { return cut_body().bvh(); }
  };
  // A grown sheet with the cut that accepted it.
  struct Grown {
    GrowthResult result;
    CutResult cut;
  };
  static constexpr std::size_t kNoSheet = static_cast<std::size_t>(-1);
  using Grow = std::function<GrowthResult(const TriangleBvh& body, const GrowthOptions& options)>;

  // What stops a crack in a piece: its stopped cracks but for number `left_out`; and what attracts it: crack walls.
  Obstacles obstacles_in(const Piece& piece, std::size_t left_out) const;
  GrowthOptions growth_options(Piece& piece, const CrackRecord& record, const Obstacles& obstacles,
                               CutResult& accepted);
  // Grows with the cut as the ladder's last test. `left_out`: the piece's stopped crack that grows on, or kNoSheet.
  Grown grow(Piece& piece, CrackRecord& record, std::size_t left_out, const Grow& grow);
  // From a seed, with edges of record.edge_length; the ligament of one that stops may fail.
  Grown start_in(Piece& piece, const CrackField& field, const CrackSeed& seed, CrackRecord& record);
  // Lets the ligament of a stopped crack fail where it cannot bear the load.
  void break_ligament(Piece& piece, const CrackField& field, Grown& grown, CrackRecord& record, std::size_t left_out);
  // Makes the crack part of the event, in the place of the stopped crack `left_out`.
  void commit(std::size_t index, Grown&& grown, CrackRecord& record, std::size_t left_out);
  // Lets the stopped crack `id` grow on wherever it is.
  void resume_crack_of(std::int32_t id, const CrackField& field, bool ligaments);
  // Cracks that ended at others go on once those have gone through.
  void join(const CrackField& field);
  CutResult cut_piece(const CutBody& body, const CrackSheet& sheet, std::int32_t crack);
  // The cut's parts take the piece's place, with its stopped cracks but for number `left_out`, and with the crack's own
  // wings, which wait for the cut.
  void replace(std::size_t index, CutResult&& cut, std::size_t left_out, const std::vector<StoppedCrack>& wings);
  // The piece whose surface the seed lies on, or whose inside if it is an interior one.
  std::size_t piece_at(const CrackSeed& seed);
  bool may_start(const CrackSeed& seed) const;
  bool split_by(std::size_t index, std::size_t k);
  void split_by_partials();
  FragmentShape finished(Piece& piece);
  void cut_notches(FragmentShape& shape);

  Solid& solid_;
  const FractureOptions& options_;
  FractureResult& result_;
  std::int32_t next_id_;
  const Guide* guide_ = nullptr;  // while start_along() runs
  int tried_ = 0, cracks_ = 0;
  std::vector<Piece> pieces_;
  std::vector<CrackSheet> grown_;  // of this event, to keep new seeds apart
};

}  // namespace sherd
