#include "src/box/box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "tests/support/random.h"
#include "tests/support/real.h"

namespace needlework {
namespace {

using test::Random;
using test::Wide;
using Place = Vector;

constexpr std::uint64_t seed_of_boxes = 4711;
constexpr Place edges_of_box{2.5, 7.3, 100.1};

Wide wide(const DoubleDouble& a) { return Wide(a.hi) + a.lo; }

TEST(Shift, AddsAndSubtracts) {
  const Shift a{1, -2, 3}, b{10, 20, -30};
  EXPECT_EQ(a + b, (Shift{11, 18, -27}));
  EXPECT_EQ(a - b, (Shift{-9, -22, 33}));
  EXPECT_EQ(-a, (Shift{-1, 2, -3}));
}

TEST(Box, WrapsIntoItselfToTheLastBit) {
  for (const double edge : {8.0, 5.0, 2.01, 10.1}) {
    const Box box({edge, 3, 3});
    for (const double boxes : {-500.0, -1.0, 0.0, 1.0, 3.0, 497.0}) {
      const double border = boxes * edge;
      for (const double x : {border, std::nextafter(border, 1e4), std::nextafter(border, -1e4),
                             border - 5e-324, border - 1e-20, border + 1e-20}) {
        const Wrapped wrapped = box.wrap({x, 1, 2});
        EXPECT_GE(wrapped.place[0], 0) << x;
        EXPECT_LT(wrapped.place[0], edge) << x;
        const Wide moved = Wide(edge) * wrapped.boxes[0] + wrapped.place[0] - x;
        EXPECT_LE(abs(moved), edge * 0x1p-53) << x;
        EXPECT_EQ(wrapped.place[1], 1);
        EXPECT_EQ(wrapped.place[2], 2);
      }
    }
  }
}

// What is wrapped is an image, and with the image added it is where it was.
TEST(Box, WrapsByWholeImages) {
  const Box box(edges_of_box);
  Random random(seed_of_boxes);
  for (int n = 0; n < 3000; ++n) {
    const Place centre{random.uniform(-1e3, 1e3), random.uniform(-1e3, 1e3),
                       random.uniform(-1e3, 1e3)};
    const auto [place, boxes] = box.wrap(centre);
    const Vec3dd image = box.image<DoubleDouble>(boxes).place;
    EXPECT_LE(abs(wide(image.x) + place[0] - centre[0]), 0x1p-53 * edges_of_box[0]);
    EXPECT_LE(abs(wide(image.y) + place[1] - centre[1]), 0x1p-53 * edges_of_box[1]);
    EXPECT_LE(abs(wide(image.z) + place[2] - centre[2]), 0x1p-53 * edges_of_box[2]);
    EXPECT_EQ(box.less(centre, boxes), place) << "seed " << seed_of_boxes << ", draw " << n;
    EXPECT_EQ(box.wrap(place).boxes, Boxes{});
  }
}

TEST(Box, HasImagesWholeEdgesAway) {
  const Box box({10.1, 0.3, 7.7});
  const Shift shift{-3, 1000000007, 5};
  const Vec3dd exact = box.image<DoubleDouble>(shift).place;
  EXPECT_TRUE(wide(exact.x) == Wide(10.1) * -3);
  EXPECT_TRUE(wide(exact.y) == Wide(0.3) * 1000000007);
  EXPECT_TRUE(wide(exact.z) == Wide(7.7) * 5);
  EXPECT_EQ(box.image(shift).place, to_double(exact));
  EXPECT_EQ(box.image(Boxes{-3, 1000000007, 5}).place, to_double(exact));
  // As its vectors say, and without a velocity.
  const auto [a, b, c] = box.vectors();
  EXPECT_EQ(box.image(Shift{1, 0, 0}).place, (Vec3d{a[0], a[1], a[2]}));
  EXPECT_EQ(box.image(Shift{0, 1, 0}).place, (Vec3d{b[0], b[1], b[2]}));
  EXPECT_EQ(box.image(Shift{0, 0, 1}).place, (Vec3d{c[0], c[1], c[2]}));
  EXPECT_EQ(box.image(shift).velocity, Vec3d{});
}

// Neither wrapped nor imaged.
TEST(Box, LeavesAxesWithWallsAlone) {
  const Box box({3, 4, 5}, {true, false, true});
  EXPECT_FALSE(box.is_periodic());
  EXPECT_TRUE(Box({3, 4, 5}).is_periodic());
  EXPECT_TRUE(box.has_image({2, 0, -1}));
  EXPECT_FALSE(box.has_image({0, 1, 0}));
  const auto [place, boxes] = box.wrap({-1, -1, 11});
  EXPECT_EQ(place, (Place{2, -1, 1}));
  EXPECT_EQ(boxes, (Boxes{-1, 0, 2}));
  EXPECT_EQ(box.nearest({2, 9, -4}), (Boxes{1, 0, -1}));
  EXPECT_EQ(box.shortest({2, 9, -4}), (Vec3d{-1, 9, 1}));
}

TEST(Box, SharesAreBelowOneAlsoBeyondWalls) {
  const Box box({3, 4, 5}, {true, false, true});
  EXPECT_EQ(box.share({-0.75, 5, 2.5}), (Place{0.75, 0.25, 0.5}));
  EXPECT_EQ(box.share({3, -1, 12.5}), (Place{0, 0.75, 0.5}));
  const double below = std::nextafter(3, 0);
  EXPECT_LT(box.share({below, below - 3, 0})[0], 1);
  EXPECT_LT(box.share({0, -5e-324, 0})[1], 1);
}

TEST(Box, FindsTheNearestImage) {
  const Box box(edges_of_box);
  Random random(seed_of_boxes);
  for (int n = 0; n < 300; ++n) {
    const Vec3d apart{random.uniform(-2, 2) * edges_of_box[0],
                      random.uniform(-2, 2) * edges_of_box[1],
                      random.uniform(-2, 2) * edges_of_box[2]};
    const Vec3d shortest = box.shortest(apart);
    EXPECT_EQ(shortest, apart - box.image(box.nearest(apart)).place);
    double least = std::numeric_limits<double>::infinity();
    for (std::int32_t x = -3; x <= 3; ++x)
      for (std::int32_t y = -3; y <= 3; ++y)
        for (std::int32_t z = -3; z <= 3; ++z) {
          const Vec3d other = apart - box.image(Shift{x, y, z}).place;
          least = std::min(least, dot(other, other));
        }
    EXPECT_NEAR(dot(shortest, shortest), least, 1e-12 * least) << seed_of_boxes << ", " << n;
  }
}

// In flights across several boxes, of which instants are looked at.
TEST(Box, VisitsAllImagesThatComeNear) {
  const Box box({2.5, 7.3, 4.1}, {true, true, false});
  Random random(seed_of_boxes);
  std::size_t near = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3d r{random.uniform(-3, 3), random.uniform(-9, 9), random.uniform(-4, 4)};
    const Vec3d v{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-1, 1)};
    const double reach = 1.1, time = 1;
    std::set<Shift> visited;
    box.for_each_image_near(r, v, reach, time, [&](const Shift& shift) {
      EXPECT_TRUE(box.has_image(shift));
      EXPECT_TRUE(visited.insert(shift).second);
    });
    for (int step = 0; step <= 100; ++step) {
      const double t = time * step / 100;
      const Vec3d apart = r + v * t;
      const Boxes nearest = box.nearest(apart);
      const auto [place, velocity] = box.image(nearest);
      const Vec3d here = apart - place - velocity * t;
      if (dot(here, here) > reach * reach) continue;
      ++near;
      EXPECT_TRUE(visited.contains(shift_of(nearest))) << seed_of_boxes << ", " << n;
    }
  }
  EXPECT_GT(near, 1000u);
}

}  // namespace
}  // namespace needlework
