// Stress of everything a closed mesh bounds, under given tractions and body force: the whole way from a mesh to
// numbers, with every refusal, residual and warning on record. `sherd stress` is this class and three CSV files.
//
//   Analysis analysis(mesh, {young / (2 * (1 + nu)), nu}, {.refine = 1});
//   const LocatedPoints points = analysis.locate(x, {});
//   if (analysis.solve(traction, force)) analysis.stress(points, sigma);
//
// The surface is taken as the polyhedron it is. Stress does not depend on Young's modulus, and only the solids' shapes
// matter to it: results scale exactly with lengths and loads.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/load/load.h"
#include "engine/mesh/thickness_resolution.h"
#include "kernels/core/symmetric.h"
#include "kernels/fundamental/elastic.h"

namespace sherd {

enum class Formulation { kDirect, kIndirect };

struct AnalysisOptions {
  std::string name = "mesh";  // stands first in errors and warnings: the file
  Formulation formulation = Formulation::kDirect;
  int refine = 0;           // every triangle becomes 4^refine of its shape; 0 to 6
  Real feature_angle = 35;  // degrees, 0 to 180: edges that turn more are creases; 0: all are (the exact polyhedron)
  Real tolerance = 1e-4;  // wanted of the stress, relative; 1e-10 to 0.1. The linear systems are solved to a hundredth
                          // of it: on thin bodies the stress errs by far more than the residual
  std::size_t max_bytes = std::size_t{8} << 30;  // of all operators together; never above 3/4 of the machine's memory
};

struct SolidReport {
  std::uint32_t first_face = 0;      // of the mesh given, the smallest that belongs to this solid
  std::size_t shells = 0;            // 1 + cavities
  std::size_t triangles = 0;         // refined
  std::size_t unknowns = 0;          // of the linear system
  Real volume = 0, area = 0;         // m^3, m^2
  Vec3 net_force, net_moment;        // of the load as given, N and N m about the centroid
  Real force_residual = 0;           // |net force| / (sum |t| A + integral |b|)
  Real moment_residual = 0;          // |net moment| / (the same times half the bounding box's diagonal)
  ResolutionReport resolution;       // elements against wall thickness, refined
  int iterations = 0, products = 0;  // of the Krylov solver
  Real residual = 0;                 // true relative residual at its end
  bool converged = false;            // to what was asked of the linear system
  bool solved = false;               // converged, or short of it by less than a factor of ten
  std::string reason;                // when not converged
};

struct StageSeconds {
  double check = 0, assemble = 0, solve = 0, recover = 0, evaluate = 0;
};

struct AnalysisReport {
  std::vector<SolidReport> solids;  // largest volume first
  bool double_storage = true;       // of the operators; single precision when double would not fit max_bytes
  StageSeconds seconds;
  std::vector<std::string> warnings;

  // Over all solids: sums, and the worst residuals.
  std::size_t triangles() const;
  std::size_t unknowns() const;
  int iterations() const;
  int products() const;
  Real residual() const;
  Real force_residual() const;
  Real moment_residual() const;
  bool solved() const;
};

// Points assigned to a solid and, on the surface, to a face of it; made by Analysis::locate().
struct LocatedPoints {
  Vec3Column position;               // m
  std::vector<std::uint32_t> solid;  // index into AnalysisReport::solids
  std::vector<std::uint32_t> face;   // of the solid's refined mesh; kNone inside
  std::size_t size() const { return solid.size(); }
};

class Analysis {
 public:
  // Throws InputError with the reason for what has no answer: an empty, open, non-manifold or misoriented mesh,
  // triangles without area, shells turned inside out or cavities that lie in no solid, surfaces that touch or cross,
  // coordinates that are not finite, nu outside (-1, 0.4999), mu not positive, options out of range, operators that
  // would not fit. Faces keep their numbers everywhere.
  Analysis(const SurfaceMesh& mesh, const Elastic& material, const AnalysisOptions& options);
  ~Analysis();
  Analysis(Analysis&&) noexcept;
  Analysis& operator=(Analysis&&) noexcept;

  // face[i]: the triangle of the mesh given that point i lies on, kNone for a point inside; empty: all inside. Points
  // that lie on the surface to a thousandth of its edges count as inside. InputError names points (labels[i], or i)
  // outside of every solid, off their face, or not finite.
  LocatedPoints locate(const Vec3Column& points, const std::vector<std::uint32_t>& face,
                       const std::vector<std::string>& labels = {}) const;

  // traction: per triangle of the mesh given, Pa; empty: none. A net force or moment of a solid is reported and taken
  // out by a rigid-motion body force (d'Alembert: the stress in the accelerated frame). Operators are built at the
  // first call. False when a solid was not solved: SolidReport::reason. InputError for values that are not finite.
  bool solve(const Vec3Column& traction, const BodyForce& force);

  // Stress at the points under the load last solved, Pa; InternalError before, or when that failed. Parallel.
  void stress(const LocatedPoints& points, std::vector<Sym3>& out);

  const AnalysisReport& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
