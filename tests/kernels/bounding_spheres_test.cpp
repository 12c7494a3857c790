// The first filter: it must never drop a pair that comes within reach, and should drop the rest.
#include "kernels/bounding_spheres.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"
#include "tests/support/real.h"

namespace needlework::kernels {
namespace {

using test::Quad;
using test::Random;
using test::vec3;

constexpr std::uint64_t spheres_seed = 808;
constexpr int spheres_count = 20000;

// The least of |r + v s|^2 for s in [0, until], in 113 bits.
Quad least_square(const Vec3d& r, const Vec3d& v, double until) {
  const auto product = [](const Vec3d& a, const Vec3d& b) {
    return Quad(Quad(a.x) * b.x + Quad(a.y) * b.y + Quad(a.z) * b.z);
  };
  const Quad rr = product(r, r), rv = product(r, v), vv = product(v, v);
  Quad s = vv > 0 ? Quad(-rv / vv) : Quad(0);
  s = std::min(std::max(s, Quad(0)), Quad(until));
  return rr + 2 * rv * s + vv * s * s;
}

// Centres that pass each other at this distance of closest approach, at `time`.
struct Passage {
  Vec3d r, v;
};
Passage passage(Random& random, double distance, double time, double speed) {
  const Vec3d v = vec3(random.direction());
  const Vec3d across = normalised(cross(v, vec3(random.direction())));
  return {across * distance - v * (speed * time), v * speed};
}

// Any motion, and passages at about the reach or farther, of which some searches end before the
// nearest approach, next to it, or after.
TEST(BoundingSpheres, DropPairsThatStayBeyondTheMarginAndNoOthers) {
  Random random(spheres_seed);
  int near = 0, apart = 0;
  for (int n = 0; n < 2 * spheres_count; ++n) {
    const double speed = random.log_uniform(1e-6, 1e6);
    const double time = random.log_uniform(1e-3, 1e3) / speed;
    const double distance = n % 2 == 0 ? 1 + (n % 8 - 4) * random.log_uniform(1e-17, 1e-1)
                                       : 1 + random.log_uniform(1e-6, 1);
    Passage p = passage(random, distance, n % 3 == 0 ? 0 : time, speed);
    double until = n % 5 == 0 ? time : (n % 5 == 1 ? 1 : 3) * time * random.uniform();
    if (n % 9 == 0) {
      p = {vec3(random.normal_vector(1.5)), vec3(random.normal_vector(1))};
      until = random.uniform(0, 4);
    }
    const double reach = n % 7 == 0 ? random.log_uniform(1e-3, 1e3) : 1;
    const Quad least = least_square(p.r, p.v, until);
    if (least > 1 && least < 1 + 0x1p-19) continue;
    ++(least > 1 ? apart : near);
    ASSERT_EQ(spheres_stay_apart(p.r * reach, p.v * reach, reach, until), least > 1)
        << "distance " << distance << ", speed " << speed << ", until " << until << ", seed "
        << spheres_seed << ", pair " << n;
  }
  EXPECT_GT(near, spheres_count / 4);
  EXPECT_GT(apart, spheres_count / 2);
}

TEST(BoundingSpheres, SettleTheSimpleCases) {
  EXPECT_FALSE(spheres_stay_apart({0.5, 0, 0}, {1, 0, 0}, 1, 1)) << "within reach at once";
  EXPECT_FALSE(spheres_stay_apart({1, 0, 0}, {0, 0, 0}, 1, 1)) << "on the border";
  EXPECT_TRUE(spheres_stay_apart({1.1, 0, 0}, {0, 0, 0}, 1, 1e300)) << "at rest";
  EXPECT_TRUE(spheres_stay_apart({1.1, 0, 0}, {1, 0, 0}, 1, 1e300)) << "parting";
  EXPECT_TRUE(spheres_stay_apart({3, 0, 0}, {-1, 0, 0}, 1, 1.9)) << "not there yet";
  EXPECT_FALSE(spheres_stay_apart({3, 0, 0}, {-1, 0, 0}, 1, 2.1)) << "there in time";
  EXPECT_TRUE(spheres_stay_apart({3, 1.01, 0}, {-1, 0, 0}, 1, 10)) << "passing by";
  EXPECT_FALSE(spheres_stay_apart({3, 0.99, 0}, {-1, 0, 0}, 1, 10)) << "passing through";
  EXPECT_FALSE(spheres_stay_apart({3, 0, 0}, {-1, 0, 0}, 1, HUGE_VAL)) << "without an end";
}

TEST(BoundingSpheres, KnowNoUnitOfTimeOrLength) {
  Random random(spheres_seed);
  for (int n = 0; n < 5000; ++n) {
    const Passage p =
        passage(random, 1 + random.uniform(-0x1p-19, 0x1p-18), random.uniform(0, 5), 1);
    const double until = random.uniform(0, 5);
    const bool says = spheres_stay_apart(p.r, p.v, 1, until);
    for (const double slow : {0x1p-60, 0x1p60, 0x1p-300}) {
      ASSERT_EQ(spheres_stay_apart(p.r, p.v * slow, 1, until / slow), says)
          << "seed " << spheres_seed;
    }
    for (const double length : {0x1p-60, 0x1p-1, 0x1p7, 0x1p100}) {
      ASSERT_EQ(spheres_stay_apart(p.r * length, p.v * length, length, until), says)
          << "seed " << spheres_seed;
    }
    ASSERT_EQ(spheres_stay_apart(-p.r, -p.v, 1, until), says) << "seed " << spheres_seed;
  }
}

}  // namespace
}  // namespace needlework::kernels
