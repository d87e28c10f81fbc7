// Polynomial fits on a patch of the surface around a vertex: tangential derivatives of whatever lives at the vertices
// (design notes, thin-walls section 7, steps 1 to 3). They carry the stress recovery and the cubic displacement.
#pragma once
#include "engine/mesh/surface_corners.h"

namespace sherd {

struct FitOptions {
  int degree = 3;         // 1 to 4
  int planar_degree = 4;  // on patches that are flat to 1e-3 of their size; at least `degree`. Degree 4 halves the
                          // error of flat plates and worsens curved shells (measured)
};

// Interpolatory weighted least squares in the coordinates X = (x - origin).a, Y = (x - origin).b of the patch: the
// value at the vertex is met, the rest in the mean with weights 1 / distance. A functional of the fit is a row of
// coefficients over the patch's vertices.
class SurfaceFit {
 public:
  // Fits over the faces of `corner` grown by rings inside the smooth group until 4 / 10 / 16 / 24 vertices (degree
  // 1 / 2 / 3 / 4) carry it. Monomials that the patch cannot resolve (strips one element wide) are dropped, and a fit
  // that would amplify noise is relaxed.
  SurfaceFit(const SurfaceMesh& mesh, const SurfaceCorners& corners, std::size_t corner, const FitOptions& options);

  const std::vector<std::uint32_t>& patch() const { return patch_; }  // patch()[0] is the vertex
  // Derivatives along X and Y at the vertex, per metre.
  const std::vector<Real>& row_x() const { return row_x_; }
  const std::vector<Real>& row_y() const { return row_y_; }
  // Slope of the surface itself over its tangent plane.
  Real slope_x() const { return slope_x_; }
  Real slope_y() const { return slope_y_; }
  const Vec3& a() const { return a_; }
  const Vec3& b() const { return b_; }
  const Vec3& normal() const { return n_; }

 private:
  void fit(int degree);
  bool fit_rows(int degree, Real drop);

  Vec3 origin_, a_, b_, n_;
  std::vector<std::uint32_t> patch_;
  std::vector<Real> x_, y_, z_, weight_;  // of patch vertices 1 ..., x and y in units of hx, hy
  Real hx_ = 0, hy_ = 0, nearest_ = 0;
  std::vector<std::vector<Real>> coefficient_;  // of X and Y, over patch vertices 1 ...; empty when unresolved
  std::vector<Real> row_x_, row_y_;
  Real slope_x_ = 0, slope_y_ = 0;
};

}  // namespace sherd
