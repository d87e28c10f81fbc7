// A body's boundary prepared for the boundary integrals: panel frames once per mesh.
#pragma once
#include <vector>

#include "engine/mesh/surface_mesh.h"
#include "kernels/quadrature/triangle.h"

namespace sherd {

// How far the closed forms and the seven-point rule reach, in longest edges of the source triangle from its centroid.
// Errors per panel (design notes, worst direction): 7 points at 3 edges 1.4e-6 | 6e-6 (value | gradient), 3 points at 8
// edges 1.9e-5 | 6e-5. Infinity for `closed_form` makes everything exact (tests).
struct QuadratureOptions {
  Real closed_form = 3;
  Real gauss7 = 8;
};

struct Boundary {
  SurfaceMesh mesh;
  std::vector<PanelFrame> panels;  // per triangle
  Vec3Column centroid;
  std::vector<Real> near2, middle2;  // squared reach of the closed forms and of the 7-point rule, m^2
  std::vector<Real> vertex_area;     // lumped: a third of the incident areas, m^2
  Real area = 0;

  Boundary(const SurfaceMesh& surface, const QuadratureOptions& options);
};

// The points that stand for panels far away, of kGauss3: three a panel, panel by panel, m.
Vec3Column far_points(const std::vector<PanelFrame>& panels);

}  // namespace sherd
