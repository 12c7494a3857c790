// What searches and the protocol of several threads rely on of a motion.
#include "src/physics/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"

namespace needlework {
namespace {

kernels::Flight draw_flight(test::Random& random) {
  const Vec3d r = test::vec3(random.normal_vector(1)), u = test::vec3(random.direction());
  return test::flight(r, u, test::vec3(random.normal_vector(1)),
                      test::vec3(random.normal_vector(3)));
}

template <NeedleMotion M>
void expect_bounds(const M& motion, test::Random& random) {
  const double from = random.uniform(0, 1), to = from + random.uniform(0, 1);
  const Vec3d before = motion.centre(from), after = motion.centre(to);
  const Vec3d way = after - before;
  EXPECT_LE(std::sqrt(dot(way, way)), motion.fastest(from, to) * (to - from) * (1 + 1e-12));
  const Vec3d turn = motion.director(to) - motion.director(from);
  EXPECT_LE(std::sqrt(dot(turn, turn)), motion.fastest_rotation(from, to) * (to - from) + 1e-12);
  const auto inside = [](const Vec3d& r, const Vec3d& low, const Vec3d& high) {
    return r.x >= low.x && r.y >= low.y && r.z >= low.z && r.x <= high.x && r.y <= high.y &&
           r.z <= high.z;
  };
  const Vec3d room{random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1)};
  const Vec3d low = before - room, high = before + room;
  const double stays = motion.time_to_leave(from, low, high);
  EXPECT_GT(stays, 0);
  for (const double share : {0.0, 0.3, 0.999999}) {
    EXPECT_TRUE(inside(motion.centre(from + share * stays), low, high)) << share;
  }
}

TEST(NeedleMotion, KeepsItsBounds) {
  test::Random random(7);
  const Vec3d gravity{0, 0.5, -2};
  for (int n = 0; n < 1000; ++n) {
    const kernels::Flight flight = draw_flight(random);
    expect_bounds(FreeFlight(flight), random);
    expect_bounds(FreeFlight(flight, &gravity), random);
  }
}

TEST(FreeFlight, LeavesExactlyThen) {
  test::Random random(8);
  const Vec3d gravity{0, 0.5, -2};
  for (int n = 0; n < 1000; ++n) {
    const kernels::Flight flight = draw_flight(random);
    const FreeFlight motion(flight, n % 2 == 0 ? nullptr : &gravity);
    const Vec3d room{1, 2, 3}, low = flight.r - room, high = flight.r + room;
    const double stays = motion.time_to_leave(0, low, high);
    const Vec3d out = motion.centre(stays * (1 + 1e-9));
    EXPECT_TRUE(out.x < low.x || out.y < low.y || out.z < low.z || out.x > high.x ||
                out.y > high.y || out.z > high.z);
  }
  const kernels::Flight still = test::flight({1, 2, 3}, {0, 0, 1}, {}, {});
  EXPECT_TRUE(std::isinf(FreeFlight(still).time_to_leave(0, {0, 0, 0}, {4, 4, 4})));
  EXPECT_TRUE(std::isinf(FreeFlight(still).lasts(1)));
  EXPECT_TRUE(std::isfinite(FreeFlight(still, &gravity).lasts(1)));
}

// So that the bound on its speed is of use to the protocol of several threads.
TEST(FreeFlight, HasABoundOnItsSpeedUnderGravity) {
  test::Random random(9);
  for (int n = 0; n < 1000; ++n) {
    const Vec3d gravity = test::vec3(random.normal_vector(random.log_uniform(1e-3, 1e3)));
    const kernels::Flight flight = draw_flight(random);
    const FreeFlight motion(flight, &gravity);
    const double speed = motion.fastest(0, 0), fall = std::sqrt(std::sqrt(dot(gravity, gravity)));
    EXPECT_LE(motion.fastest(0, motion.lasts(1)), 10 * (speed + fall));
    // And renewals are not too frequent.
    EXPECT_GE(motion.lasts(1) * (speed + fall),
              0.25 * std::min(speed * speed / (fall * fall), 1.0));
  }
}

}  // namespace
}  // namespace needlework
