// Distances of segments in double and in the SIMD kernels' float, and the sine and cosine of the
// latter.
#include "kernels/closest_approach.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/exposed_simd.h"
#include "tests/support/by_build.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"
#include "tests/support/segments.h"

namespace needlework::kernels {
namespace {

using test::Random;
using test::vec3;

constexpr std::uint64_t approach_seed = 1010;
constexpr int approach_thin = test::by_build(1, 20);

struct Segments {
  Vec3d r, u1, u2;  ///< first centre less the second
  double half1 = 0.5, half2 = 0.5;
};

double in_double(const Segments& s) {
  const Vec3d x = cross(s.u1, s.u2);
  return segment_distance_squared(s.r, s.u1, s.u2, x, dot(x, x), half_lengths(s.half1, s.half2));
}

double in_float(const Segments& s) {
  using scalar::Floats;
  using V = scalar::exposed::V3;
  const auto floats = [](const Vec3d& a) {
    return V{static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
  };
  const V u1 = floats(s.u1), u2 = floats(s.u2), x = cross(u1, u2);
  const Floats half1(static_cast<float>(s.half1)), half2(static_cast<float>(s.half2));
  return scalar::exposed::segment_distance_squared(floats(s.r), u1, u2, x, dot(x, x),
                                                   scalar::exposed::half_lengths(half1, half2))
      .v;
}

double truth(const Segments& s) {
  const Vec3d gap = test::nearest_points(s.r, s.u1, {}, s.u2, s.half1, s.half2).gap;
  return dot(gap, gap);
}

// Below this angle the nearest points are taken at the middle; elsewhere they are as good as the
// numbers are. Both are far below the margins of all filters, 2^-18 and more.
constexpr double parallel = 0x1p-20;

void expect_right(const Segments& s) {
  const double d = std::sqrt(truth(s)), size = std::sqrt(dot(s.r, s.r)) + 1;
  const Vec3d x = cross(s.u1, s.u2);
  const bool nearly_parallel = std::sqrt(dot(x, x)) < 1.001 * parallel;
  EXPECT_NEAR(std::sqrt(in_double(s)), d, (nearly_parallel ? 0.5 * parallel : 0x1p-30) * size);
  EXPECT_NEAR(std::sqrt(in_float(s)), d, parallel * size);
  // Never a distance that is not there: both points lie on the segments.
  EXPECT_GE(std::sqrt(in_double(s)), d - 0x1p-48 * size);
}

TEST(SegmentDistance, IsThatOfTheNearestPoints) {
  Random random(approach_seed);
  for (int n = 0; n < 200000 / approach_thin; ++n) {
    Segments s{vec3(random.direction()) * random.uniform(0, 2), vec3(random.direction()),
               vec3(random.direction())};
    const int kind = random.below(6);
    if (kind == 0) s.u2 = s.u1 * (random.coin() ? 1 : -1);
    if (kind == 1)
      s.u2 = normalised(s.u1 + vec3(random.direction()) * random.log_uniform(1e-12, 0.1));
    if (kind == 2) s.r = s.u1 * random.uniform(-1.5, 1.5) + s.u2 * random.uniform(-1.5, 1.5);
    if (kind == 3) s.r = s.r * random.log_uniform(1e-9, 1);
    if (random.coin()) {
      s.half1 = random.log_uniform(0.01, 0.5);
      s.half2 = random.log_uniform(0.01, 0.5);
    }
    ASSERT_NO_FATAL_FAILURE(expect_right(s));
    ASSERT_FALSE(HasFailure()) << "kind " << kind << ", seed " << approach_seed << ", case " << n;
  }
}

TEST(SegmentDistance, IsRightInDegenerateCases) {
  const Vec3d x{1, 0, 0}, y{0, 1, 0};
  const struct {
    Segments segments;
    double distance;
  } cases[] = {{{{0, 0, 0}, x, x}, 0},
               {{{0, 0, 0}, x, -x}, 0},
               {{{0, 0, 0}, x, y}, 0},
               {{{0, 0, 1}, x, x}, 1},
               {{{0, 0, 1}, x, y}, 1},
               {{{2, 0, 0}, x, x}, 1},
               {{{1, 0, 0}, x, x}, 0},
               {{{0.8, 0, 0}, x, x}, 0},
               {{{0.5, 0.5, 0}, x, y}, 0},
               {{{1.5, 0, 0}, x, y}, 1},
               {{{0, 3, 0}, x, y}, 2.5},
               {{{1, 1, 0}, x, y}, std::sqrt(0.5)},
               {{{2, 0, 1}, x, -x}, std::sqrt(2)},
               {{{-0.5, 0.25, 0}, x, y}, 0},
               {{{2, 0, 0}, x, x, 0.25, 0.5}, 1.25},
               {{{1.5, 0, 0}, x, y, 0.125, 0.5}, 1.375},
               {{{0, 3, 0}, x, y, 0.125, 0.25}, 2.75},
               {{{0.25, 0.5, 1}, x, y, 0.25, 0.5}, 1},
               {{{0.5, 0.5, 1}, x, y, 0.25, 0.25}, std::sqrt(1.125)}};
  for (const auto& [segments, distance] : cases) {
    EXPECT_NEAR(in_double(segments), distance * distance, 1e-15) << distance;
    EXPECT_NEAR(in_float(segments), distance * distance, 1e-6) << distance;
    EXPECT_NEAR(truth(segments), distance * distance, 1e-15) << distance;
  }
}

void expect_right(float angle) {
  const auto turned = scalar::exposed::sine_cosine(angle);
  const double exact = angle;
  EXPECT_NEAR(turned.sine.v, std::sin(exact), 0x1p-20) << std::hexfloat << angle;
  EXPECT_NEAR(turned.cosine.v, std::cos(exact), 0x1p-20) << std::hexfloat << angle;
}

TEST(SineCosineOfFloats, IsGoodTo20BitsForAnglesBelow4096) {
  Random random(approach_seed);
  for (int n = 0; n < 2000000 / approach_thin; ++n) {
    const double size = random.coin() ? 0x1p12 * random.uniform()
                                      : std::ldexp(random.uniform(), 13 - random.below(40));
    expect_right(static_cast<float>(std::min(size, 0x1p12) * (random.coin() ? 1 : -1)));
    ASSERT_FALSE(HasFailure());
  }
  // Around all multiples of an eighth of a circle.
  for (int k = 0; k <= 5215; ++k) {
    float angle = static_cast<float>(k * 0.78539816339744831);
    for (int n = 0; n < 3; ++n) angle = std::nextafter(angle, -1.0f);
    for (int n = 0; n < 7; ++n) {
      expect_right(angle);
      expect_right(-angle);
      angle = std::nextafter(angle, 1e9f);
    }
    ASSERT_FALSE(HasFailure());
  }
  expect_right(0x1p12f);
  expect_right(-0x1p12f);
}

}  // namespace
}  // namespace needlework::kernels
