// How a quantity of the material varies from place to place, as plain data: what a scene says, before there is a mesh.
#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "engine/material/scalar_field.h"
#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct ConstantSpec {
  Real value = 0;
};

// Gradient noise g in [-1, 1], smooth, with features of about the wavelength.
struct NoiseSpec {
  Real mean = 1;
  Real amplitude = 0;      // relative; below 1 unless lognormal
  Real wavelength = 1;     // m
  bool lognormal = false;  // mean exp(amplitude g) instead of mean (1 + amplitude g)
  std::uint64_t seed = 0;
};

// values[i] where offsets[i - 1] <= x . axis < offsets[i]; over `blend` metres about each offset a linear transition.
struct LayerSpec {
  Vec3 axis{0, 1, 0};         // unit
  std::vector<Real> offsets;  // m, ascending, at least `blend` apart
  std::vector<Real> values;   // one more than offsets
  Real blend = 0;             // m
};

inline constexpr Real kWidestBoundary = 0.25;

// Voronoi cells of points strewn one to a cube of the side `size`.
struct GrainSpec {
  Real mean = 1;
  Real size = 1;      // m
  Real spread = 0;    // relative, below 1: a grain's value is uniform in mean (1 +- spread)
  Real boundary = 1;  // factor at the boundary of two grains, rising linearly to 1 inside
  Real width = 0.1;   // of size: distance from a boundary up to which it counts
  std::uint64_t seed = 0;
};

// The mesh's channel `name`: 0 (and below) stands for `low`, 1 (and above) for `high`. Inside the body: the value of
// the nearest point of the surface.
struct AttributeSpec {
  std::string name;
  Real low = 0, high = 1;
};

// A part of another field (of the strength).
struct ShareSpec {
  Real factor = 1;
};

using FieldSpec = std::variant<ConstantSpec, NoiseSpec, LayerSpec, GrainSpec, AttributeSpec, ShareSpec>;

struct FieldBounds {
  Real lower = 0, upper = 0;
};
// `whole`: of the field a ShareSpec is a part of.
FieldBounds bounds_of(const FieldSpec& spec, const FieldBounds& whole);
// `whole`: the field a ShareSpec is a part of, may be null for every other. Throws InputError when `mesh` lacks the
// channel of an AttributeSpec.
ScalarFieldPtr make_field(const FieldSpec& spec, const SurfaceMesh& mesh, const ScalarFieldPtr& whole);

// The lesser of two fields at every point.
ScalarFieldPtr lesser_field(ScalarFieldPtr a, ScalarFieldPtr b);

}  // namespace sherd
