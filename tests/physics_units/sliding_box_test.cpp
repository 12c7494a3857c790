// Rows of boxes that slide: exact at any age, and the same however the slide is reduced.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/box/box.h"
#include "src/box/shear.h"
#include "tests/support/random.h"

namespace needlework {
namespace {

__extension__ using Whole = __int128;

// Of rates, edges and times that are multiples of powers of two, the slide is a whole number.
TEST(RowSlide, IsExactAfterAnyNumberOfEpochs) {
  test::Random random(1);
  for (int n = 0; n < 10000; ++n) {
    const auto edge = 1 + static_cast<std::int64_t>(random.bits() >> 44);              // of 2^-16
    const auto velocity = static_cast<std::int64_t>(random.bits() >> 44) - (1 << 19);  // of 2^-16
    const auto epoch = static_cast<std::int64_t>(random.bits() >> (2 + random.below(60)));
    const auto offset = static_cast<std::int64_t>(random.bits() >> 34);  // of 2^-32
    const double length = static_cast<double>(edge) * 0x1p-16;
    const double start = random.uniform() * length;
    Shear shear(static_cast<double>(velocity) * 0x1p-16, {length, 1, 1}, start);
    shear.set_epoch(0.25);
    ASSERT_TRUE(shear.is_followable());
    const RowSlide slide = shear.at(epoch, static_cast<double>(offset) * 0x1p-32);
    // In 2^-48, modulo 2^32 edges.
    const Whole of_edge = Whole{edge} << 32, all = of_edge << 32;
    const Whole expected = Whole{velocity} * ((Whole{epoch} << 30) + offset) % all;
    const DoubleDouble rest = slide.offset - DoubleDouble(start);
    const Whole got = slide.boxes * of_edge + static_cast<Whole>(rest.hi * 0x1p48) +
                      static_cast<Whole>(std::nearbyint(rest.lo * 0x1p48));
    Whole off = (got - expected) % all;
    if (off < 0) off += all;
    if (off > all / 2) off -= all;
    ASSERT_LE(std::abs(static_cast<double>(off)), 2)
        << "velocity " << velocity << ", edge " << edge << ", epoch " << epoch;
    ASSERT_GE(slide.offset.hi, -1e-15);
    ASSERT_LE(slide.offset.hi, length * (1 + 1e-15));
  }
}

TEST(SlidingBox, IsTheSameHoweverItsSlideIsReduced) {
  test::Random random(2);
  for (int n = 0; n < 10000; ++n) {
    const Vector edges{random.uniform(2, 9), random.uniform(2, 9), random.uniform(2, 9)};
    const double velocity = random.uniform(-5, 5);
    const DoubleDouble offset(random.uniform(0, edges[0]));
    const auto boxes = static_cast<std::uint32_t>(random.bits());
    const Box box = Box(edges).with_rows({velocity, offset, boxes});
    const Box other = Box(edges).with_rows({velocity, offset - DoubleDouble(edges[0]), boxes + 1});
    const Vector centre{random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-30, 30)};
    const Wrapped a = box.wrap(centre), b = other.wrap(centre);
    ASSERT_EQ(a.place, b.place);
    ASSERT_EQ(a.boxes, b.boxes);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_GE(a.place[axis], 0);
      ASSERT_LT(a.place[axis], edges[axis]);
    }
    // What has been wrapped away leads back.
    const Image<DoubleDouble> image = box.image<DoubleDouble>(a.boxes);
    ASSERT_NEAR(a.place[0] + to_double(image.place.x), centre[0], 1e-13);
    ASSERT_NEAR(a.place[1] + to_double(image.place.y), centre[1], 1e-13);
    ASSERT_EQ(image.velocity.x, velocity * a.boxes[1]);
    ASSERT_EQ(to_double(image.place.x), to_double(other.image<DoubleDouble>(a.boxes).place.x));
    const Vec3d apart{centre[0], centre[1], centre[2]};
    ASSERT_EQ(box.nearest(apart), other.nearest(apart));
  }
}

// Images that come near in the time ahead, against all there are.
TEST(SlidingBox, FindsEveryImageThatComesNear) {
  test::Random random(3);
  std::size_t found = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vector edges{random.uniform(2, 4), random.uniform(2, 4), random.uniform(2, 4)};
    const RowSlide above{random.uniform(-5, 5), DoubleDouble(random.uniform(0, edges[0])), 7};
    const Box box = Box(edges).with_rows(above);
    const Vec3d r{random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)};
    const Vec3d v{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    const double time = random.uniform(0, 2);
    std::vector<Shift> seen;
    box.for_each_image_near(r, v, 1, time, [&](const Shift& shift) { seen.push_back(shift); });
    for (std::int32_t y = -6; y <= 6; ++y) {
      for (std::int32_t x = -30; x <= 30; ++x) {
        for (std::int32_t z = -6; z <= 6; ++z) {
          const Shift shift{x - 7 * y, y, z};
          const Image<double> image = box.image(shift);
          const Vec3d at = r - image.place, relative = v - image.velocity;
          const double turn = std::clamp(-dot(at, relative) / dot(relative, relative), 0.0, time);
          const Vec3d nearest = at + relative * turn;
          if (dot(nearest, nearest) > 1) continue;
          ++found;
          ASSERT_EQ(std::count(seen.begin(), seen.end(), shift), 1);
        }
      }
    }
  }
  EXPECT_GT(found, 300u);
}

}  // namespace
}  // namespace needlework
