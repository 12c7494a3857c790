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

/// A second motion, as an effect would bring it: free flight under an acceleration. Shows that the
/// interface suffices for one whose speed changes.
class Falling {
 public:
  Falling(const kernels::Flight& flight, const Vec3d& g) : flight_(flight), free_(flight), g_(g) {}
  Vec3d centre(double t) const { return free_.centre(t) + g_ * (0.5 * t * t); }
  Vec3d director(double t) const { return free_.director(t); }
  Vec3d velocity(double t) const { return flight_.v + g_ * t; }
  Vec3d angular_velocity(double t) const { return free_.angular_velocity(t); }
  double fastest(double from, double to) const {
    const auto speed = [&](double t) { return std::sqrt(dot(velocity(t), velocity(t))); };
    return std::max(speed(from), speed(to));  // the speed is convex in time
  }
  double fastest_rotation(double from, double to) const { return free_.fastest_rotation(from, to); }
  double time_to_leave(double t, const Vec3d& low, const Vec3d& high) const {
    // A lower bound is enough: the nearest side at twice the present speed, while that holds.
    const Vec3d r = centre(t);
    const double room =
        std::min({r.x - low.x, r.y - low.y, r.z - low.z, high.x - r.x, high.y - r.y, high.z - r.z});
    const double speed = fastest(t, t), pull = std::sqrt(dot(g_, g_));
    return room <= 0 ? 0 : std::min(room / (2 * speed), speed / pull);
  }
  double lasts(double length) const { return free_.lasts(length); }

 private:
  kernels::Flight flight_;
  FreeFlight free_;
  Vec3d g_;
};
static_assert(NeedleMotion<Falling>);

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
  for (int n = 0; n < 1000; ++n) {
    const kernels::Flight flight = draw_flight(random);
    expect_bounds(FreeFlight(flight), random);
    expect_bounds(Falling(flight, {0, 0, -2}), random);
  }
}

TEST(FreeFlight, LeavesExactlyThen) {
  test::Random random(8);
  for (int n = 0; n < 1000; ++n) {
    const kernels::Flight flight = draw_flight(random);
    const FreeFlight motion(flight);
    const Vec3d room{1, 2, 3}, low = flight.r - room, high = flight.r + room;
    const double stays = motion.time_to_leave(0, low, high);
    const Vec3d out = motion.centre(stays * (1 + 1e-9));
    EXPECT_TRUE(out.x < low.x || out.y < low.y || out.z < low.z || out.x > high.x ||
                out.y > high.y || out.z > high.z);
  }
  const kernels::Flight still = test::flight({1, 2, 3}, {0, 0, 1}, {}, {});
  EXPECT_TRUE(std::isinf(FreeFlight(still).time_to_leave(0, {0, 0, 0}, {4, 4, 4})));
  EXPECT_TRUE(std::isinf(FreeFlight(still).lasts(1)));
}

}  // namespace
}  // namespace needlework
