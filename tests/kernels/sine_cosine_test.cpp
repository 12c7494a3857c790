// Sine and cosine against fifty and a hundred digits.
#include "kernels/sine_cosine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "tests/support/random.h"
#include "tests/support/real.h"

namespace needlework {
namespace {

using boost::multiprecision::cpp_bin_float_50;
using test::Random;
using test::Wide;

constexpr std::uint64_t sine_seed = 202;
constexpr double half_pi = 0x1.921fb54442d18p+0;

// Distance from the exact value in units of the spacing of doubles there.
double error_in_ulps(double computed, const cpp_bin_float_50& exact) {
  const double size = std::abs(static_cast<double>(exact));
  const double ulp = std::ldexp(1.0, std::max(std::ilogb(size), DBL_MIN_EXP) - 52);
  return std::abs(static_cast<double>(cpp_bin_float_50((computed - exact) / ulp)));
}

class Worst {
 public:
  void take(double x) {
    const SineCosine<double> computed = sine_cosine(x);
    const cpp_bin_float_50 exact = x;
    sine_ = std::max(sine_, error_in_ulps(computed.sine, sin(exact)));
    cosine_ = std::max(cosine_, error_in_ulps(computed.cosine, cos(exact)));
  }
  void expect_below(double ulps) const {
    std::printf("largest error: %.4f ulp of sines, %.4f of cosines\n", sine_, cosine_);
    EXPECT_LT(sine_, ulps);
    EXPECT_LT(cosine_, ulps);
  }

 private:
  double sine_ = 0, cosine_ = 0;
};

// In general, for small arguments, next to multiples of pi/2, and next to odd ones of pi/4: there
// the reduction changes from one multiple to the next, and the rest is largest.
TEST(SineCosine, IsWithinFourFifthsOfAnUlp) {
  Random random(sine_seed);
  Worst anywhere, small, at_multiples, between;
  for (int i = 0; i < 10000; ++i) anywhere.take(random.uniform(-0x1p12, 0x1p12));
  for (int i = 0; i < 10000; ++i) anywhere.take(random.uniform(-2, 2));
  for (int exponent = -1060; exponent <= 0; ++exponent)
    small.take(std::ldexp(random.uniform(1, 2), exponent));
  for (int n = 1; n * half_pi <= 0x1p12; ++n) {
    const double x = static_cast<double>(n * (boost::math::constants::half_pi<cpp_bin_float_50>()));
    for (const double near : {x, std::nextafter(x, 0), -std::nextafter(x, HUGE_VAL)})
      at_multiples.take(near);
  }
  for (int n = 0; n * half_pi <= 0x1p12; n += 2) {
    const double x = (n + 0.5) * half_pi;
    for (const double near : {x * (1 - 0x1p-50), x, x * (1 + 0x1p-50)}) between.take(near);
  }
  for (const Worst& worst : {anywhere, small, at_multiples, between}) worst.expect_below(0.8);
}

TEST(SineCosine, BeyondTwoToTheTwelfthTheErrorGrowsWithTheArgument) {
  Random random(sine_seed);
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform(1, 2) * std::ldexp(random.coin() ? 1 : -1, 12 + i % 28);
    const SineCosine<double> computed = sine_cosine(x);
    const cpp_bin_float_50 exact = x;
    const double bound = std::abs(x) * 0x1p-52;
    ASSERT_LT(abs(computed.sine - sin(exact)), bound) << "x = " << x << ", seed " << sine_seed;
    ASSERT_LT(abs(computed.cosine - cos(exact)), bound) << "x = " << x << ", seed " << sine_seed;
  }
}

TEST(SineCosine, TinyAnglesAreTheirOwnSines) {
  for (const double x : {DBL_TRUE_MIN, 3 * DBL_TRUE_MIN, DBL_MIN, 0x1p-600, 0x1.8p-30}) {
    EXPECT_EQ(sine_cosine(x).sine, x);
    EXPECT_EQ(sine_cosine(-x).sine, -x);
  }
  for (const double x : {0.0, DBL_TRUE_MIN, DBL_MIN, 0x1p-600, 0x1p-28}) {
    EXPECT_EQ(sine_cosine(x).cosine, 1);
  }
  EXPECT_EQ(sine_cosine(0.0).sine, 0);
}

TEST(SineCosine, OfTheOppositeAngleIsMirroredBitForBit) {
  Random random(sine_seed);
  const auto expect_mirrored = [](const auto& x) {
    const auto a = sine_cosine(x), b = sine_cosine(-x);
    EXPECT_EQ(a.sine, -b.sine);
    EXPECT_EQ(a.cosine, b.cosine);
  };
  for (int i = 0; i < 100000; ++i) {
    const double x = std::ldexp(random.uniform(1, 2), i % 60 - 20);
    expect_mirrored(x);
    if (i % 10 == 0) expect_mirrored(two_sum(x, x * random.uniform(-0x1p-54, 0x1p-54)));
    ASSERT_FALSE(HasFailure()) << std::hexfloat << x << ", seed " << sine_seed;
  }
}

Wide wide_of(const DoubleDouble& a) { return Wide(a.hi) + Wide(a.lo); }

// Largest error over 2^-100 (1 + |x|), |x| about 2^exponent.
double worst_precise(Random& random, int exponent, int count) {
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double hi = std::ldexp(random.uniform(-2, 2), exponent);
    const DoubleDouble x = two_sum(hi, hi * random.uniform(-0x1p-54, 0x1p-54));
    const SineCosine<DoubleDouble> computed = sine_cosine(x);
    const double unit = 0x1p-100 * (1 + std::abs(hi));
    const auto error = [&](const DoubleDouble& a, const Wide& exact) {
      return std::abs(static_cast<double>(Wide(wide_of(a) - exact))) / unit;
    };
    worst = std::max(
        {worst, error(computed.sine, sin(wide_of(x))), error(computed.cosine, cos(wide_of(x)))});
  }
  return worst;
}

TEST(SineCosineInDoubleDouble, IsWithinItsBound) {
  Random random(sine_seed);
  for (int exponent = -60; exponent <= 39; ++exponent) {
    const double worst = worst_precise(random, exponent, 20);
    if (exponent % 10 == 0) std::printf("2^%d: %.4f of the bound\n", exponent, worst);
    EXPECT_LT(worst, 1) << "|x| about 2^" << exponent << ", seed " << sine_seed;
  }
}

TEST(SineCosineInDoubleDouble, IsWithinItsBoundNextToQuarterPi) {
  for (int n = 1; n < 300; ++n) {
    const Wide exact = n * boost::math::constants::half_pi<Wide>() / 2;
    const double hi = static_cast<double>(exact);
    const DoubleDouble x(hi, static_cast<double>(Wide(exact - hi)));
    const SineCosine<DoubleDouble> computed = sine_cosine(x);
    const Wide bound = 0x1p-100 * (1 + hi);
    EXPECT_LT(abs(wide_of(computed.sine) - sin(wide_of(x))), bound) << n << " quarters of pi";
    EXPECT_LT(abs(wide_of(computed.cosine) - cos(wide_of(x))), bound) << n << " quarters of pi";
  }
}

// The reduction takes off multiples of pi/2 in three parts; without the third, the error would grow
// with the argument.
TEST(SineCosineInDoubleDouble, LosesNothingByReductionOfArgumentsInUse) {
  Random random(sine_seed);
  for (int exponent = 0; exponent <= 12; ++exponent) {
    const double worst = worst_precise(random, exponent, 100);
    EXPECT_LT(worst * (1 + std::ldexp(1.0, exponent)), 1)
        << "|x| about 2^" << exponent << ", seed " << sine_seed;
  }
}

TEST(SineCosineInDoubleDouble, TinyAnglesAreTheirOwnSines) {
  for (const double x : {0.0, DBL_TRUE_MIN, DBL_MIN, 0x1p-600}) {
    EXPECT_EQ(sine_cosine(DoubleDouble(x)).sine, DoubleDouble(x));
    EXPECT_EQ(to_double(sine_cosine(DoubleDouble(x)).cosine), 1);
  }
}

}  // namespace
}  // namespace needlework
