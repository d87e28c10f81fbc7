// The inner loops of the operator's rows: eight targets at once, one a SIMD lane. The same source is compiled for the
// baseline processor and for AVX-512 and chosen at run time, so everything passes as plain arrays: code shared with
// other translation units must not be compiled for a processor that may be absent.
#pragma once
#include <cstddef>
#include <cstdint>

namespace sherd {

struct PanelFrame;

inline constexpr std::size_t kLanes = 8;

// A panel as the loops see it. Units m, m^2 for the area, 1/m for the gradients of the coordinates s and t.
struct LanePanel {
  double three[3][3], six[6][3];  // points of kGauss3 and kGauss6
  double normal[3], gradient_s[3], gradient_t[3];
  double area;
};

// K = one I / l + two r r^T / l^3; the double layer times `angle`.
struct LaneConstants {
  double one, two, angle;
};

// Freedoms of a panel, as cubic.h counts them (kHermite): three vertices, six slopes.
inline constexpr std::size_t kPanelFreedoms = 9;

// Weights of the freedoms' shape functions (cubic.h) and of their derivatives: over the six quadratic monomials (shape
// over the ten cubic ones), and over the values at the points of the two rules, exact for kernels that vary linearly
// (three) or quadratically (six) over the panel.
struct LaneTables {
  double monomial_s[9][6], monomial_t[9][6], monomial_shape[9][10];
  double three_s[9][3], three_t[9][3], three_shape[9][3];
  double six_s[9][6], six_t[9][6], six_shape[9][6];
};

// Integrals against the monomials, for the lanes in closed form; zero in the others.
struct LaneMoments {
  double kernel[6][6][kLanes];  // [monomial][xx, yy, zz, yz, xz, xy]
  double angle[10][kLanes];
};

// One block of three rows by three columns for all lanes: [row][column][lane].
inline constexpr std::size_t kLaneBlock = 9 * kLanes;

// The transposed reconstruction of a block of panels, flattened: see Reconstruction. What the freedoms add to vertices
// at once, and by way of the gradients fitted at corners.
struct LaneGather {
  struct Entry {
    std::uint32_t freedom, vertex;
    double weight;
  };
  struct Term {
    std::uint32_t freedom;
    double x, y, z;
  };
  struct Corner {
    std::uint32_t first_term, last_term, first_gradient, last_gradient;
    double frame_x[9], frame_y[9];
  };
  struct Gradient {
    std::uint32_t vertex;
    double x, y;
  };
  const Entry* entries;
  std::size_t entry_count;
  const Term* terms;
  const Corner* corners;
  std::size_t corner_count;
  const Gradient* gradients;
};

// Point forces: positions and forces as six arrays of `count` numbers each.
struct LaneSources {
  const double *x, *y, *z, *fx, *fy, *fz;
  std::size_t count;
};

// What triangles send out into Somigliana's gradient, concentrated at points: density f of the Kelvin layer, M u, the
// surface gradient (row major) and the normal. Arrays of `count` numbers.
struct LaneElements {
  const double *y[3], *density[3], *guenter[3], *gradient[9], *normal[3];
  std::size_t count;
};

struct LaneKernels {
  // x: three coordinates of the lanes, 3 kLanes. mask: 1 or 0 a lane. local: the panel's freedoms, indices into
  // `freedoms` (kLaneBlock numbers each), which is added to; total (kLanes) gathers the double layer of 1.
  void (*three_points)(const LanePanel&, const LaneTables&, const LaneConstants&, const double* x,
                       const std::uint32_t* local, double* freedoms, double* total);
  void (*six_points)(const LanePanel&, const LaneTables&, const LaneConstants&, const double* x, const double* mask,
                     const std::uint32_t* local, double* freedoms, double* total);
  void (*moments)(const LanePanel&, const LaneTables&, const LaneMoments&, const std::uint32_t* local, double* freedoms,
                  double* total);
  // Closed forms (kernels/quadrature/moments.h) times the constants for the lanes with `wanted` 1, zero in the others;
  // `on` is 1 for targets on the panel. Lanes that the one-by-one form must serve (slender panels, targets close to an
  // edge) stay wanted and zero, the others become 0.
  void (*panel_moments)(const PanelFrame&, const LaneConstants&, const double* x, const double* on, double* wanted,
                        LaneMoments&);
  // freedoms -> vertices (added to).
  void (*gather)(const LaneGather&, const double* freedoms, double* vertices);
  // u (3 kLanes) += weight (a number a lane) times the sum over sources of ((3 - 4 nu) f + r (r f) / l^2) / l, `ratio`
  // = 3 - 4 nu; sources whose squared distance is not above `least` add nothing.
  void (*kelvin_sum)(const LaneSources&, double ratio, double least, const double* x, const double* weight, double* u);
  // gradient (9 kLanes, [i][k] = u_i,k) += sum over the elements' points; kelvin = 1/(16 pi mu (1 - nu)), the rest as
  // in kelvin_sum.
  void (*gradient_sum)(const LaneElements&, double kelvin, double ratio, double least, const double* x,
                       double* gradient);
  // Block `in` times weight[a] to each of a panel's freedoms local[a].
  void (*add_weighted)(const double* in, const double* weight, const std::uint32_t* local, double* freedoms);
};

// The fastest this processor runs.
const LaneKernels& lane_kernels();
const LaneKernels& baseline_lane_kernels();

}  // namespace sherd
