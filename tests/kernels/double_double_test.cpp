// Double-double arithmetic against a hundred digits.
#include "kernels/double_double.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "tests/support/random.h"
#include "tests/support/real.h"

namespace needlework {
namespace {

using test::Random;
using test::Wide;

constexpr std::uint64_t digits_seed = 101;
constexpr int digits_count = 20000;

Wide wide(const DoubleDouble& a) { return Wide(a.hi) + Wide(a.lo); }

// Significand of 1 to 53 random bits, so that ties and short numbers are common.
double draw_double(Random& random, int exponents) {
  const int bits = 1 + random.below(53);
  const auto significand = static_cast<std::int64_t>(random.bits() >> (64 - bits) | 1);
  const double size = std::ldexp(static_cast<double>(significand), -bits);
  const int exponent = random.below(2 * exponents + 1) - exponents;
  return std::ldexp(random.coin() ? size : -size, exponent);
}

// Low parts from none over tiny to the largest that a normalised number can have.
DoubleDouble draw_digits(Random& random, int exponents) {
  const double hi = draw_double(random, exponents);
  const double half_ulp = std::ldexp(1.0, std::ilogb(hi) - 53);
  switch (random.below(4)) {
    case 0:
      return hi;
    case 1:
      return two_sum(hi, random.uniform(-half_ulp, half_ulp));
    case 2:
      return two_sum(hi, (random.coin() ? 1 : -1) * half_ulp * (1 - 0x1p-53));
    default:
      return two_sum(hi, half_ulp * std::ldexp(random.uniform(-1, 1), -random.below(60)));
  }
}

double relative_error(const DoubleDouble& computed, const Wide& exact) {
  if (exact == 0) return computed.hi == 0 && computed.lo == 0 ? 0 : HUGE_VAL;
  return std::abs(static_cast<double>(Wide((wide(computed) - exact) / exact)));
}

// Largest relative error of an operation over random operands; the low part must be below half an
// ulp of the high one.
template <class Operation, class Exact>
double worst_error(int exponents, Operation operation, Exact exact) {
  Random random(digits_seed);
  double worst = 0;
  for (int i = 0; i < digits_count; ++i) {
    const DoubleDouble a = draw_digits(random, exponents);
    DoubleDouble b = draw_digits(random, exponents);
    // Every fourth time nearly equal or opposite, so that sums cancel.
    if (i % 4 == 0) {
      const double factor = (random.coin() ? 1 : -1) * (1 + std::ldexp(1.0, -random.below(110)));
      b = a * DoubleDouble(factor);
    }
    const DoubleDouble c = operation(a, b);
    EXPECT_EQ(c.hi, c.hi + c.lo) << "seed " << digits_seed << ", operands " << i;
    worst = std::max(worst, relative_error(c, exact(wide(a), wide(b))));
    if (testing::Test::HasFailure()) break;
  }
  std::printf("largest relative error: 2^%.2f\n", std::log2(worst));
  return worst;
}

TEST(DoubleDouble, SumIsWithinItsBound) {
  const auto sum = [](const auto& a, const auto& b) { return a + b; };
  EXPECT_LT(worst_error(40, sum, sum), 0x1p-104);
  const auto difference = [](const auto& a, const auto& b) { return a - b; };
  EXPECT_LT(worst_error(3, difference, difference), 0x1p-104);
}

TEST(DoubleDouble, ProductIsWithinItsBound) {
  const auto product = [](const auto& a, const auto& b) { return a * b; };
  EXPECT_LT(worst_error(200, product, product), 0x1p-103);
}

TEST(DoubleDouble, QuotientIsWithinItsBound) {
  const auto quotient = [](const auto& a, const auto& b) { return a / b; };
  EXPECT_LT(worst_error(200, quotient, quotient), 0x1p-104);
}

TEST(DoubleDouble, SquareRootIsWithinItsBound) {
  const auto magnitude = [](const DoubleDouble& a) { return a.hi < 0 ? -a : a; };
  const auto root = [&](const DoubleDouble& a, const DoubleDouble&) { return sqrt(magnitude(a)); };
  const auto exact = [](const Wide& a, const Wide&) { return Wide(sqrt(Wide(abs(a)))); };
  EXPECT_LT(worst_error(200, root, exact), 0x1p-103);
  EXPECT_EQ(sqrt(DoubleDouble()), DoubleDouble());
}

TEST(DoubleDouble, TwoSumIsExactForAnyOrderOfOperands) {
  Random random(digits_seed);
  for (int i = 0; i < digits_count; ++i) {
    const double a = draw_double(random, 60), b = draw_double(random, 60);
    const DoubleDouble sum = two_sum(a, b);
    ASSERT_TRUE(wide(sum) == Wide(a) + Wide(b))
        << "seed " << digits_seed << ": " << a << " + " << b;
    ASSERT_EQ(sum.hi, a + b);
    ASSERT_EQ(sum, two_sum(b, a));
    const DoubleDouble quick = std::abs(a) >= std::abs(b) ? quick_two_sum(a, b) : sum;
    ASSERT_EQ(sum, quick) << "seed " << digits_seed << ": " << a << " + " << b;
  }
}

TEST(DoubleDouble, TwoSumIsExactAmongSubnormals) {
  Random random(digits_seed);
  for (int i = 0; i < digits_count; ++i) {
    const double a = DBL_TRUE_MIN * std::floor(random.uniform(-0x1p54, 0x1p54));
    const double b = DBL_TRUE_MIN * std::floor(random.uniform(-8, 8));
    ASSERT_TRUE(wide(two_sum(a, b)) == Wide(a) + Wide(b)) << "seed " << digits_seed;
  }
}

void expect_exact_product(double a, double b) {
  const DoubleDouble product = two_prod(a, b);
  ASSERT_TRUE(wide(product) == Wide(a) * Wide(b)) << std::hexfloat << a << " * " << b;
  ASSERT_EQ(product.hi, a * b);
  ASSERT_EQ(product, two_prod(b, a));
  ASSERT_EQ(product, -two_prod(a, -b));
}

TEST(DoubleDouble, TwoProductIsExact) {
  Random random(digits_seed);
  for (int i = 0; i < digits_count; ++i) {
    SCOPED_TRACE(i);
    ASSERT_NO_FATAL_FAILURE(
        expect_exact_product(draw_double(random, 200), draw_double(random, 200)));
  }
}

// The range that the header promises: factors below 2^990, product below 2^1023, its low part
// normal.
TEST(DoubleDouble, TwoProductIsExactUpToItsLimits) {
  const double largest = std::ldexp(2 - DBL_EPSILON, 989);
  for (const double a : {largest, largest / 3, 1 + DBL_EPSILON, 2 - DBL_EPSILON}) {
    expect_exact_product(a, std::ldexp(2 - DBL_EPSILON, 32));
    expect_exact_product(a, std::ldexp(1 + DBL_EPSILON, -900));
    expect_exact_product(largest, std::ldexp(a, -970));
  }
  // Low part of the product: at least 2^(-450 - 450 - 106) = 2^-1006.
  expect_exact_product(std::ldexp(1 + DBL_EPSILON, -450), std::ldexp(2 - DBL_EPSILON, -450));
}

TEST(DoubleDouble, SignsAndOrderChangeNoBit) {
  Random random(digits_seed);
  for (int i = 0; i < digits_count; ++i) {
    const DoubleDouble a = draw_digits(random, 30), b = draw_digits(random, 30);
    ASSERT_EQ(a + b, b + a) << "seed " << digits_seed;
    ASSERT_EQ(a * b, b * a) << "seed " << digits_seed;
    ASSERT_EQ(a - b, -(b - a)) << "seed " << digits_seed;
    ASSERT_EQ((-a) * b, -(a * b)) << "seed " << digits_seed;
    ASSERT_EQ((-a) / b, -(a / b)) << "seed " << digits_seed;
    const Vec3dd x{a, b, a - b}, y{b, a * b, a};
    ASSERT_EQ(cross(x, y), -cross(y, x)) << "seed " << digits_seed;
  }
}

TEST(DoubleDouble, PowersOfTwoScaleExactly) {
  Random random(digits_seed);
  const auto scaled = [](const DoubleDouble& a, int power) {
    return DoubleDouble(std::ldexp(a.hi, power), std::ldexp(a.lo, power));
  };
  for (int i = 0; i < digits_count; ++i) {
    const DoubleDouble a = draw_digits(random, 10), b = draw_digits(random, 10);
    ASSERT_EQ(scaled(a, 60) + scaled(b, 60), scaled(a + b, 60)) << "seed " << digits_seed;
    ASSERT_EQ(scaled(a, 60) * scaled(b, -110), scaled(a * b, -50)) << "seed " << digits_seed;
    ASSERT_EQ(scaled(a, 60) / scaled(b, -110), scaled(a / b, 170)) << "seed " << digits_seed;
    if (a.hi > 0) {
      ASSERT_EQ(sqrt(scaled(a, 60)), scaled(sqrt(a), 30)) << "seed " << digits_seed;
    }
  }
}

TEST(DoubleDouble, RoundsToTheNearestDouble) {
  EXPECT_EQ(to_double(DoubleDouble(1, 0x1p-60)), 1);
  EXPECT_EQ(to_double(DoubleDouble(1) / DoubleDouble(3)), 1.0 / 3);
  EXPECT_EQ(to_double(DoubleDouble(0x1p60) - DoubleDouble(1) - DoubleDouble(0x1p60)), -1);
}

}  // namespace
}  // namespace needlework
