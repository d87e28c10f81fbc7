#include "engine/scene/quality.h"

#include <algorithm>

#include "engine/scene/scene.h"

namespace sherd {
namespace {

struct Setting {
  Real edges;                       // factor of edge lengths; time grows with about their fourth power the other way
  Real tolerance;                   // factor of the solver's
  Real time_step;                   // factor
  int frames;                       // pictures made of so many that the scene asks for: 1 of `frames`
  int least_samples, most_samples;  // per pixel
};

Setting setting(Quality quality) {
  switch (quality) {
    case Quality::kPreview:
      // The step stays: a longer one saves next to nothing beside the solves and lets more pass between two looks at
      // the contacts.
      return {1.6, 10, 1, 2, 1, 2};
    case Quality::kDefault:
      break;
    case Quality::kFine:
      return {0.6, 0.1, 0.5, 1, 8, 8};
  }
  return {1, 1, 1, 1, 1, 8};
}

// Walls whose bending a scene resolves stay resolved: past three thicknesses an edge it comes out wrong.
constexpr Real kLongestPerThickness = 3;

}  // namespace

void apply_quality(Quality quality, Scene& scene) {
  const Setting s = setting(quality);
  scene.quality = quality;
  for (SceneBody& body : scene.bodies) {
    body.edge_factor = s.edges;
    if (body.edge_per_thickness > 0)
      body.edge_per_thickness =
          std::min(s.edges * body.edge_per_thickness, std::max(body.edge_per_thickness, kLongestPerThickness));
  }
  // So the same walls are averaged in all three. Collocation at two thicknesses an edge errs by 10 % in plates (H3 at
  // h/T = 2, as measured), less on shells.
  scene.solver.edge_factor = s.edges;
  scene.solver.tolerance = std::clamp(s.tolerance * scene.solver.tolerance, 1e-14, 0.1);
  scene.time_step *= s.time_step;
  scene.frame_rate /= s.frames;
  scene.output.samples = std::clamp(scene.output.samples, s.least_samples, s.most_samples);
}

}  // namespace sherd
