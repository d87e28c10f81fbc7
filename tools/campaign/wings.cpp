// What closed rings leave behind goes on in the pieces, as in a fracture event.
#include "engine/fracture/check_growth.h"
#include "engine/fracture/thicken.h"
#include "tools/campaign/crack.h"

namespace sherd::campaign {
namespace {

bool touches(const CrackSheet& sheet, const TriangleBvh& body) {
  for (std::size_t v = 0; v < sheet.state.size(); ++v)
    if (sheet.state[v] != NodeState::kExited && body.inside(sheet.position[v])) return true;
  return false;
}

// The first law that the wing breaks in this piece, or nothing; `out`: the cut by one that went through.
std::string go_on(const CutBody& piece, const CrackField& field, const CrackSheet& wing, GrowthOptions options,
                  Real min_fragment_volume, CutResult& out) {
  Obstacles obstacles;
  obstacles.set_walls(piece.mesh());
  options.obstacles = &obstacles;
  options.accept = [&](const CrackSheet& sheet) {
    std::string reason;
    const auto slab = thicken(sheet, {.thickness = options.thickness, .crack = 1}, reason);
    if (!slab) return reason;
    CutOptions o;
    o.edge_length = options.edge_length, o.min_fragment_volume = min_fragment_volume, o.slab_checked = true;
    out = cut(piece, *slab, o);
    return out.reason;
  };
  const GrowthResult grown = resume_crack(piece.bvh(), field, wing, options);
  if (std::string bad = check_growth(grown, piece.bvh(), options); !bad.empty()) return bad;
  if (grown.outcome != GrowthOutcome::kComplete) {
    out = {};
    return {};
  }
  return check_cut_laws(piece, out);
}

}  // namespace

std::string grow_wings(const Specimen& s, const CrackField& field, const GrowthOptions& options,
                       Real min_fragment_volume, Crack& crack) {
  std::vector<SurfaceMesh>& fragments = crack.cut.fragments;
  for (const CrackSheet& wing : crack.growth.wings) {
    std::vector<SurfaceMesh> pieces;
    bool through = false;
    for (SurfaceMesh& fragment : fragments) {
      const CutBody piece(fragment);
      CutResult c;
      if (touches(wing, piece.bvh()))
        if (std::string bad =
                go_on(piece, field, wing, options, min_fragment_volume * s.body.volume() / piece.volume(), c);
            !bad.empty())
          return "a wing: " + bad;
      through = through || c.ok;
      crack.cut.removed_volume += c.removed_volume, crack.cut.dust_volume += c.dust_volume;
      if (c.ok)
        std::move(c.fragments.begin(), c.fragments.end(), std::back_inserter(pieces));
      else
        pieces.push_back(std::move(fragment));
    }
    fragments = std::move(pieces);
    crack.report.wings_through += through;
  }
  return {};
}

}  // namespace sherd::campaign
