// A freshly cut piece made fit for the next solve: no slivers, the volume kept, features kept, or left as it is.
#pragma once
#include <string>

#include "engine/mesh/remesh.h"

namespace sherd {

struct RefitOptions {
  Real edge_length = 0;         // target h, metres
  Real edge_per_thickness = 0;  // of SizingOptions; 0: h everywhere
  Real least_angle = 1;         // degrees that every triangle must have
  // Of the piece's volume. Where only finer edges would keep that, up to five times as much is taken; a piece too small
  // for either gets the attempt that comes closest, as long as it keeps this part of 10 h^3.
  Real max_volume_change = 2e-4;
  // Where the piece refitted so has walls too thin for its edges (what thickness_resolution.h warns of, or a place
  // twice as bad as its limit), edges become at most this many wall thicknesses long, down to an eighth of edge_length;
  // the rule asks for 3, and edges come out up to a third longer than their target. 0: off, and where more than a fifth
  // of the surface is too coarse, edge_per_thickness has been chosen so. A wedge that tapers to nothing is never
  // resolved: a piece gets at most `most_refinement` times its triangles. The same bounds the attempts with finer
  // edges, which every later solve would pay for: all together they make at most so many times the triangles of the
  // first attempt (or of 1000, where it makes fewer), those expected to make more are left out.
  Real edge_per_thin_wall = 2;
  Real most_refinement = 3;
};

struct RefitReport {
  bool ok = false;
  std::string strategy;                   // which attempt succeeded
  std::string reason;                     // of a refusal: what the attempts ended with
  int attempts = 0;                       // remeshings done
  Real min_angle = 0;                     // of the result, degrees
  Real volume_change = 0;                 // (result - piece) / piece
  std::size_t below_1 = 0, below_15 = 0;  // triangles of the result with a smaller angle, degrees
  int wall_passes = 0;                    // of grading by edge_per_thin_wall; then
  Real thin_walls = 0;  // the result's share of area with edges too long for the wall there (ResolutionReport)
};

// Attempts from the cheapest to the dearest, until one keeps every promise of the options and is a valid mesh: near
// poor triangles only; with close features merged; in a wider zone; with much finer edges just where poor triangles are
// left; slivers alone; with thin sheets pinched where their rim has such triangles; with finer edges all over the zone.
// Otherwise `out` is the piece. Then thin walls, by edge_per_thin_wall. `piece` is closed, 2-manifold and without
// self-intersections; its lines between faces of different kind or crack id and its creases stay, as remesh() says.
// Deterministic. Throws InputError for options out of range.
RefitReport refit(const SurfaceMesh& piece, const RefitOptions& options, SurfaceMesh& out);

}  // namespace sherd
