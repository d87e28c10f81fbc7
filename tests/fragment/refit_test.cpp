// Pieces as cuts leave them, several generations deep, made fit for the next solve.
#include "engine/mesh/refit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/mesh/certificate.h"
#include "engine/mesh/shapes.h"
#include "engine/mesh/thickness_resolution.h"
#include "kernels/core/error.h"
#include "tests/fragment/slabs.h"

namespace sherd {
namespace {

Vec3 random_direction(Random& random) {
  for (;;) {
    const Real x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const Vec3 d{x, y, z};
    if (norm2(d) <= 1 && norm2(d) > 0.01) return normalized(d);
  }
}

// A wavy slab through the piece somewhere near the middle of its box, or through its surface.
SurfaceMesh random_slab(const SurfaceMesh& piece, Real h, bool on_surface, std::int32_t crack, Random& random) {
  const Box box = bounding_box(piece);
  const Real d = box.diagonal();
  SlabShape s;
  s.centre = box.centre() + 0.12 * d * random_direction(random);
  if (on_surface)
    s.centre = piece.centroid(static_cast<std::size_t>(random.uniform(0, static_cast<Real>(piece.triangle_count()))));
  s.normal = random_direction(random);
  s.half_u = s.half_v = 0.8 * d + h;
  s.cells = std::max(3, static_cast<int>(2 * s.half_u / h));
  s.thickness = 0.03 * h;
  s.wave = random.uniform(0, 0.06) * d, s.wave_number = random.uniform(1, 6) / d, s.phase = random.uniform(0, 6);
  SurfaceMesh slab = make_slab(s);
  slab.faces.crack.assign(slab.triangle_count(), crack);
  return slab;
}

struct Generations {
  std::size_t pieces = 0, refits = 0, refused = 0;
  std::string reasons;
  Real volume_error = 0;  // of the body's: pieces, what the slabs removed and the body do not balance by this much
};

// Every piece is cut and refitted until there are `least` of them; every result is certified.
Generations break_up(const SurfaceMesh& body, Real h, std::size_t least, bool on_surface, std::uint64_t seed) {
  Random random(seed);
  Generations g;
  const Real volume = signed_volume(body);
  std::vector<SurfaceMesh> pieces{body};
  Real removed = 0;
  std::int32_t crack = 0;
  for (int generation = 0; generation < 8 && pieces.size() < least; ++generation) {
    std::vector<SurfaceMesh> next;
    for (const SurfaceMesh& piece : pieces) {
      CutOptions options;
      options.edge_length = h;
      options.min_fragment_volume = 1e-5 * volume / signed_volume(piece);
      const CutResult c = cut(piece, random_slab(piece, h, on_surface, ++crack, random), options);
      if (!c.ok || signed_volume(piece) < 1e-3 * volume) {
        next.push_back(piece);
        continue;
      }
      removed += c.removed_volume + c.dust_volume;
      for (const SurfaceMesh& cut_piece : c.fragments) {
        RefitOptions fit;
        fit.edge_length = h;
        SurfaceMesh out;
        const RefitReport report = refit(cut_piece, fit, out);
        const MeshCertificate certificate = certify(out);
        EXPECT_TRUE(certificate.ok()) << certificate.first_defect;
        EXPECT_EQ(certificate.below_1_degree, report.below_1);
        if (report.ok) {
          EXPECT_EQ(certificate.below_1_degree, 0u) << report.strategy;
        } else {
          EXPECT_EQ(out, cut_piece);
          EXPECT_FALSE(report.reason.empty());
        }
        ++g.refits, g.refused += !report.ok;
        if (!report.ok) g.reasons += "\n" + report.reason;
        next.push_back(std::move(out));
      }
    }
    pieces = std::move(next);
  }
  Real sum = removed;
  for (const SurfaceMesh& piece : pieces) sum += signed_volume(piece);
  g.pieces = pieces.size(), g.volume_error = std::abs(sum - volume) / volume;
  return g;
}

// Issue: at least 64 pieces, no triangle under a degree, the volume within a thousandth.
TEST(SlowRefit, SixtyFourPiecesOfEachBodyAreFitForTheNextSolve) {
  const struct {
    const char* name;
    SurfaceMesh mesh;
    Real h;
    bool on_surface;
  } bodies[] = {{"sphere", make_sphere(0.5, 0.07), 0.07, false},
                {"cube", make_box({1, 1, 1}, 0.1), 0.1, false},
                {"plate", make_plate(1.5, 1.5, 0.05, 0.05), 0.05, false},
                {"hollow sphere", make_hollow_sphere(0.5, 0.4, 0.06), 0.06, true},
                {"torus", make_torus(0.5, 0.2, 0.06), 0.06, true}};
  for (const auto& body : bodies) {
    const Generations g = break_up(body.mesh, body.h, 64, body.on_surface, 1);
    EXPECT_GE(g.pieces, 64u) << body.name;
    EXPECT_EQ(g.refused, 0u) << body.name << " of " << g.refits << g.reasons;
    EXPECT_LT(g.volume_error, 1e-3) << body.name;
  }
}

TEST(Refit, PiecesOfACubeKeepTheirVolumeAndGetNoSlivers) {
  const Generations g = break_up(make_box({1, 1, 1}, 0.2), 0.2, 8, false, 4);
  EXPECT_GE(g.pieces, 8u);
  EXPECT_EQ(g.refused, 0u);
  EXPECT_LT(g.volume_error, 2e-4);
}

// Two wedges of 12 degrees: a plate cut aslant.
std::vector<SurfaceMesh> wedges(Real h) {
  const Real angle = 12 * std::numbers::pi / 180;
  SlabShape s;
  s.normal = {std::sin(angle), std::cos(angle), 0};
  s.half_u = s.half_v = 2, s.cells = 40, s.thickness = 1e-3, s.wave = 0;
  const CutResult c = cut_of(make_box({2, 0.4, 1}, h), make_slab(s));
  EXPECT_TRUE(c.ok) << c.reason;
  return c.fragments;
}

TEST(Refit, ThinEdgesOfACutGetElementsInKeepingAndLittleElseChanges) {
  for (const SurfaceMesh& piece : wedges(0.1)) {
    RefitOptions options;
    options.edge_length = 0.1;
    SurfaceMesh graded, uniform;
    const RefitReport report = refit(piece, options, graded);
    options.edge_per_thin_wall = 0;
    const RefitReport without = refit(piece, options, uniform);
    ASSERT_TRUE(report.ok && without.ok) << report.reason;
    EXPECT_EQ(without.wall_passes, 0);
    EXPECT_GE(report.wall_passes, 1);
    const ResolutionReport before = resolution_report(uniform), after = resolution_report(graded);
    EXPECT_EQ(resolution_warnings(before).size(), 1u);
    EXPECT_TRUE(resolution_warnings(after).empty()) << after.share_above_5_percent;
    EXPECT_EQ(after.share_above_5_percent, report.thin_walls);
    EXPECT_TRUE(certify(graded).ok());
    EXPECT_GE(report.min_angle, 1);
    EXPECT_LT(std::abs(report.volume_change), 2e-4);  // RefitOptions::max_volume_change
    EXPECT_NEAR(signed_volume(graded), (1 + report.volume_change) * signed_volume(piece), 1e-12);
    EXPECT_LE(graded.triangle_count(), 3 * uniform.triangle_count());
  }
}

TEST(Refit, AWedgeThatNoTrianglesWouldResolveAndACoarseBodyStayAsTheyAre) {
  const SurfaceMesh piece = wedges(0.1)[0];
  RefitOptions options;
  options.edge_length = 0.1, options.most_refinement = 1;
  SurfaceMesh bounded, plate;
  EXPECT_EQ(refit(piece, options, bounded).wall_passes, 0);
  // Everywhere five times as long as its wall is thick.
  const RefitReport report = refit(make_plate(1, 1, 0.02, 0.1), {.edge_length = 0.1}, plate);
  EXPECT_TRUE(report.ok) << report.reason;
  EXPECT_EQ(report.wall_passes, 0);
  EXPECT_GT(report.thin_walls, 0.9);
  options.most_refinement = 0.5;
  EXPECT_THROW(refit(piece, options, bounded), InputError);
}

TEST(Refit, TheSameCutGivesTheSameBits) {
  const SurfaceMesh body = make_sphere(0.5, 0.1);
  Random random(3);
  const CutResult c = cut_of(body, random_slab(body, 0.1, false, 1, random));
  ASSERT_TRUE(c.ok) << c.reason;
  SurfaceMesh a, b;
  RefitOptions options;
  options.edge_length = 0.1;
  EXPECT_TRUE(refit(c.fragments[0], options, a).ok);
  EXPECT_TRUE(refit(c.fragments[0], options, b).ok);
  EXPECT_EQ(a, b);
}

TEST(Refit, WhatCannotBeDoneLeavesThePieceAsItIs) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.2);
  Random random(5);
  const CutResult c = cut_of(body, random_slab(body, 0.2, false, 1, random));
  ASSERT_TRUE(c.ok) << c.reason;
  RefitOptions options;
  options.edge_length = 0.2, options.least_angle = 59;  // no mesh of a box has that
  SurfaceMesh out;
  const RefitReport report = refit(c.fragments[0], options, out);
  EXPECT_FALSE(report.ok);
  EXPECT_NE(report.reason.find("degrees"), std::string::npos);
  EXPECT_EQ(out, c.fragments[0]);
}

// Linear paint on flat faces: what the cut interpolates and the refit samples is exact but for single precision, a few
// roundings of values below 2.
TEST(Refit, PaintOfOriginalFacesSurvivesCutAndRefitAtEachPoint) {
  const auto paint = [](const Vec3& p) { return p.x + 0.5 * p.y + 0.25 * p.z; };
  SurfaceMesh body = make_box({1, 1, 1}, 0.2);
  body.channels = {{"paint", 1, {}}};
  for (std::size_t t = 0; t < body.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) body.channels[0].value.push_back(static_cast<float>(paint(body.corner(t, k))));
  Random random(7);
  const CutResult c = cut_of(body, random_slab(body, 0.2, false, 1, random));
  ASSERT_TRUE(c.ok) << c.reason;
  for (const SurfaceMesh& piece : c.fragments) {
    RefitOptions options;
    options.edge_length = 0.2;
    SurfaceMesh out;
    ASSERT_TRUE(refit(piece, options, out).ok);
    ASSERT_TRUE(certify(out).ok());
    ASSERT_EQ(out.channels.size(), 1u);
    for (std::size_t t = 0; t < out.triangle_count(); ++t) {
      if (out.faces.kind[t] == FaceKind::kCrack) continue;
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(out.channels[0].value[3 * t + k], paint(out.corner(t, static_cast<int>(k))), 1e-6);
    }
  }
}

TEST(Refit, OptionsOutOfRangeAreRefused) {
  const SurfaceMesh body = make_box({1, 1, 1}, 0.5);
  SurfaceMesh out;
  EXPECT_THROW(refit(body, {}, out), InputError);
  EXPECT_THROW(refit(body, {.edge_length = 0.5, .edge_per_thickness = -1}, out), InputError);
  EXPECT_THROW(refit(body, {.edge_length = 0.5, .least_angle = 60}, out), InputError);
  EXPECT_THROW(refit(body, {.edge_length = 0.5, .max_volume_change = 0}, out), InputError);
}

}  // namespace
}  // namespace sherd
