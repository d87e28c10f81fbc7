#include <gtest/gtest.h>

#include "tests/rigid/bodies.h"

namespace sherd {
namespace {

// Runs until the bodies have met and parted: the step in which they met, and two more in which nothing may happen.
// Returns the velocity of the first body before that step.
Vec3 run_through_contact(Sim& run) {
  for (int i = 0; i < 20000; ++i) {
    const Vec3 before = run.bodies[0].velocity;
    run.step();
    if (run.contacts.empty()) continue;
    return before;
  }
  ADD_FAILURE() << "the bodies never met";
  return {};
}

// Without gravity the law is exact for a flat box and for a sphere that lands on a vertex: Newton's, to the tolerance
// of the solve, 1e-5 of the approach at each of up to nine contacts.
TEST(Restitution, BodiesLeaveTheGroundWithTheirShareOfTheSpeed) {
  for (const Real dt : {1e-4, 1e-3, 1e-2})
    for (const Real speed : {0.5, 5.0, 50.0})
      for (const Real e : {0.0, 0.3, 0.9})
        for (const bool box : {false, true}) {
          Sim run;
          run.options.gravity = {0, 0, 0}, run.options.dt = dt;
          run.ground.enabled = true, run.ground.restitution = 0;
          const Real start = 0.06 + 20 * std::min(dt, 1e-3) * speed;
          run.bodies = {make_body(1, box ? make_box({0.1, 0.1, 0.1}, 0.05) : make_sphere(0.05, 0.02), {0, start, 0},
                                  {0, -speed, 0})};
          run.bodies[0].material.restitution = e;
          run_through_contact(run);
          EXPECT_NEAR(run.bodies[0].velocity.y, e * speed, 1e-3 * speed)
              << dt << ' ' << speed << ' ' << e << ' ' << box;
        }
}

// With gravity the height of each bounce is e^2 of the one before. The flight is exact; the bounce happens up to 1e-3
// of the diagonal (0.17 mm) above the ground and the apex is sampled, together under 2 % of the lowest height used.
TEST(Restitution, HeightOfABounceIsTheSquareOfTheRestitution) {
  for (const Real dt : {1e-4, 1e-3, 1e-2}) {
    Sim run;
    run.options.dt = dt;
    run.ground.enabled = true, run.ground.restitution = 0.8;
    run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.05), {0, 0.55, 0})};
    run.bodies[0].material.restitution = 0;
    Real top = 0;
    bool bounced = false;
    for (Real t = 0; t < 0.62; t += dt) {
      run.step();
      bounced = bounced || run.bodies[0].velocity.y > 0;
      if (bounced) top = std::max(top, run.bodies[0].pose.position.y - 0.05);
    }
    EXPECT_NEAR(top, 0.5 * 0.64, 0.02 * 0.32) << dt;
  }
}

TEST(Restitution, BodiesPartWithTheirShareOfTheSpeed) {
  for (const Real dt : {1e-4, 1e-3, 1e-2})
    for (const Real speed : {1.0, 40.0})
      for (const Real e : {0.0, 0.5, 1.0}) {
        Sim run;
        run.options.gravity = {0, 0, 0}, run.options.dt = dt;
        const Real gap = 20 * std::min(dt, 1e-3) * speed;
        // Different masses, faces parallel.
        run.bodies = {make_body(1, make_box({0.1, 0.1, 0.1}, 0.05), {0, 0, 0}, {speed, 0, 0}),
                      make_body(2, make_box({0.2, 0.12, 0.14}, 0.05), {0.15 + gap, 0, 0})};
        for (Body& b : run.bodies) b.material.restitution = e;
        const Vec3 p = momentum(run);
        run_through_contact(run);
        EXPECT_NEAR(run.bodies[1].velocity.x - run.bodies[0].velocity.x, e * speed, 1e-3 * speed) << dt << ' ' << e;
        EXPECT_LT(norm(momentum(run) - p), 1e-12 * norm(p));
      }
}

// Off centre as well. Facets turn the normal, so the law is asked of the contact's own: at its point, along its normal.
// Facets push beside the centre and so give a spin of up to 10 rad/s; the bodies move on by up to 5 mm in the rest of
// the step, so the velocity of the point where they met differs from that at the impact by up to 0.05 m/s, 1 %.
TEST(Restitution, SpheresPartWithTheirShareOfTheSpeedAlongTheirNormal) {
  for (const Real e : {0.0, 0.5, 1.0})
    for (const Real offset : {0.0, 0.03, 0.06}) {
      Sim run;
      run.options.gravity = {0, 0, 0};
      run.bodies = {make_body(1, make_sphere(0.05, 0.008), {-0.2, 0, 0}, {5, 0, 0}),
                    make_body(2, make_sphere(0.05, 0.008), {0, offset, 0})};
      for (Body& b : run.bodies) b.material.restitution = e, b.material.friction = 0;
      run_through_contact(run);
      Real approach = 0;
      for (const Contact& c : run.contacts) {
        if (norm2(c.impulse) == 0) continue;
        const Vec3 v = velocity_at(run.bodies[0], c.point) - velocity_at(run.bodies[1], c.point);
        EXPECT_NEAR(dot(v, c.normal), e * c.approach_speed, 0.01 * 5 + 1e-2 * c.approach_speed) << e << ' ' << offset;
        approach = std::max(approach, c.approach_speed);
      }
      // The normal of the first touch is that of round spheres but for edge / (2 r) = 0.08 rad of either.
      const Real sine = offset / 0.1, cosine = std::sqrt(1 - sine * sine);
      EXPECT_NEAR(approach, 5 * cosine, 5 * (0.16 * sine + 0.0128 * cosine));
    }
}

}  // namespace
}  // namespace sherd
