// A crack that is told where to run (the paper's Figure 8): along a plane, a line on the surface swept inward, or a
// surface. The guide is a stress field of its own, so that the crack grows by the same rules as any other.
#pragma once
#include <optional>

#include "engine/fracture/grow.h"
#include "engine/material/guide_spec.h"

namespace sherd {

// The same guide, independent of the body: a plane with a depth becomes the line in which it enters `body`. Pieces of
// that body then follow what the whole was told, not where their own crack walls lie nearest.
GuideSpec pinned(const GuideSpec& spec, const TriangleBvh& body);

struct GuideShape;

class Guide {
 public:
  // `mesh` and its `body`: what is to be cracked; edge_length: of the crack, m. Valid for pieces of that body too.
  Guide(const GuideSpec& spec, const TriangleBvh& body, const SurfaceMesh& mesh, Real edge_length);

  // Where the crack starts: one place on each curve in which the guide meets the body's surface, as flat and as square
  // to the guide as the curve has and near the guide's reference point. Curves whose crack another one has grown
  // already (around a cavity) are for the caller to skip. Empty when the guide misses the body. `strength`: the seeds'
  // stress, Pa.
  std::vector<CrackSeed> seeds(Real strength) const;

  struct Place {
    Vec3 point, normal;  // of the guide, nearest to the point asked; unit
    Real beyond = 0;     // how far past the guide's border the point lies, m; 0: beside it
  };
  Place nearest(const Vec3& x) const;
  const SurfaceMesh& surface() const { return surface_; }
  Real edge_length() const { return edge_length_; }

 private:
  Guide(GuideShape shape, const TriangleBvh& body, const SurfaceMesh& mesh, Real edge_length);
  Real edge_length_;
  SurfaceMesh surface_;
  TriangleBvh bvh_;
  std::vector<std::uint8_t> border_edge_;    // per directed edge 3 f + k
  std::vector<std::uint8_t> border_vertex_;  // per vertex
  std::vector<CrackSeed> seeds_;
};

// How far a crack's nodes lie from its guide, m; those past the surface of the body, which end wherever that is, aside.
struct GuideDeviation {
  Real rms = 0, largest = 0;
};
GuideDeviation deviation(const CrackSheet& sheet, const Guide& guide);

// Of edges: a crack with a node farther from its guide than this has not followed it. Bends of radius r are followed
// within about h / r edges, kinks rounded over one.
inline constexpr Real kOffGuide = 1;

// Stress that pulls a crack from `seed` along the guide: `strength` (Pa) on it, none beyond its border. The direction
// is asked for as by a driver who looks half a step ahead, where the front is going (away from the seed when it has not
// begun): the plane through the point asked and the guide there, so that a front that left the guide returns to it.
class GuideField final : public CrackField {
 public:
  GuideField(const Guide& guide, const CrackSeed& seed, Real strength)
      : guide_(guide), seed_(seed), strength_(strength) {}
  void principal_stress(const Vec3Column& points, std::vector<PrincipalStress>& out) const override;
  void stress_ahead(const Vec3Column& points, const Vec3Column& headings,
                    std::vector<PrincipalStress>& out) const override;

 private:
  PrincipalStress at(const Vec3& x, const Vec3& heading) const;
  const Guide& guide_;
  CrackSeed seed_;
  Real strength_;
};

// The wedge a notch removes: closed, outward, `width` at the surface, a straight edge at the guide's depth, reaching
// two edge lengths out of the body. Nothing when a plane runs along the surface where it should start. A line that
// bends within its own width gives a wedge that intersects itself, which the cut refuses.
std::optional<SurfaceMesh> notch_wedge(const NotchSpec& notch, const TriangleBvh& body, Real width, Real edge_length);

}  // namespace sherd
