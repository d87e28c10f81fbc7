// Bodies and loads whose cracks textbooks describe: how a bar with a notch, a stick of chalk, a beam or a plate breaks.
// No exact stress; the tests and scenes look at the path of the crack. Lengths in m, tractions of order 1 Pa.
#pragma once
#include <functional>
#include <string>

#include "engine/load/load.h"
#include "kernels/fundamental/elastic.h"

namespace sherd::exact {

struct Breakage {
  std::string name;
  SurfaceMesh mesh;
  Elastic material;
  Real edge = 0;  // of the mesh, m
  // At a point of the original surface with outward unit normal n, Pa; zero on free faces.
  std::function<Vec3(const Vec3& x, const Vec3& n)> traction;
};

// The tractions on the original faces of `mesh` (the whole body, or a piece of it after a cut: crack walls are free),
// quadratic on each triangle, with inertia relief: a uniform and a linear body force balance what is left over.
Load breakage_load(const Breakage& b, const SurfaceMesh& mesh);

// V notch with a rounded root across a bar's side, cut into it along z.
struct Notch {
  Real depth = 0;        // m
  Real angle = 0;        // between its flanks, degrees
  Real root_radius = 0;  // m
};

// Mode I (the paper's figure 15): 1 x 3 x 0.5 along y, notch in the side x = -1/2 at y = 0, pulled by 1 Pa at both
// ends.
Breakage notched_bar(Real edge, const Notch& notch = {0.25, 60, 0.06});
// Cylinder about y, radius 0.5, length 4, a slightly thinner middle so that it breaks there; twisted by its ends with
// shear tractions proportional to the radius. `turn`: +1 or -1, sense of the end at +y about y.
Breakage chalk(Real edge, Real turn = 1);
// Beam 4 x 1 x 0.5 (x, y, z) pressed down at x = 0 on its top, supported near its ends below. With a notch: in its
// lower side at x = `notch_place`.
Breakage bent_beam(Real edge, const Notch& notch = {}, Real notch_place = 0);
// Plate 2 x 2 x 0.12 (thin along y) struck down at the middle of its upper face; free elsewhere, held by its inertia.
Breakage struck_plate(Real edge);

}  // namespace sherd::exact
