// Interval arithmetic holds the exact result, whatever the numbers.
#include "src/audit/ball.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "tests/support/random.h"

namespace needlework::audit {

// Short names for numbers, which the tests' names hold.
struct InDouble {
  using Real = double;
};
struct InQuad {
  using Real = Quad;
};

namespace {

using Wide = boost::multiprecision::cpp_bin_float_100;
constexpr int draws = 20000;

/// A ball, and a number in it.
template <class Real>
struct Known {
  Ball<Real> ball;
  Wide exact;
};

template <class Real>
Known<Real> draw(test::Random& random) {
  const double size = std::ldexp(1.0, static_cast<int>(random.uniform(-20, 20)));
  const double middle = random.uniform(-1, 1) * size;
  const double radius = random.coin() ? 0 : random.uniform() * std::abs(middle) * 1e-10;
  return {Ball<Real>(Real(middle), radius), Wide(middle) + Wide(radius) * random.uniform(-1, 1)};
}

template <class Real>
bool holds(const Ball<Real>& ball, const Wide& exact) {
  return abs(Wide(ball.middle) - exact) <= Wide(ball.radius);
}

template <class Numbers>
class BallTest : public testing::Test {};
using AllNumbers = testing::Types<InDouble, InQuad>;
TYPED_TEST_SUITE(BallTest, AllNumbers);

TYPED_TEST(BallTest, HoldsTheExactResult) {
  test::Random random(5);
  for (int n = 0; n < draws; ++n) {
    const auto a = draw<typename TypeParam::Real>(random),
               b = draw<typename TypeParam::Real>(random);
    EXPECT_TRUE(holds(a.ball + b.ball, Wide(a.exact + b.exact)));
    EXPECT_TRUE(holds(a.ball - b.ball, Wide(a.exact - b.exact)));
    EXPECT_TRUE(holds(a.ball * b.ball, Wide(a.exact * b.exact)));
    EXPECT_TRUE(holds(a.ball / b.ball, Wide(a.exact / b.exact)));
    EXPECT_TRUE(holds(sqrt(a.ball * a.ball), Wide(abs(a.exact))));
    EXPECT_LE(lower(a.ball), static_cast<double>(abs(a.exact)));
    EXPECT_GE(upper(a.ball), static_cast<double>(abs(a.exact)));
    if (this->HasFailure()) break;
  }
}

TYPED_TEST(BallTest, HoldsSineAndCosine) {
  test::Random random(6);
  for (int n = 0; n < draws / 20; ++n) {
    const auto a = draw<typename TypeParam::Real>(random);
    if (abs(a.exact) > 4096) continue;
    EXPECT_TRUE(holds(sin(a.ball), Wide(sin(a.exact)))) << a.exact;
    EXPECT_TRUE(holds(cos(a.ball), Wide(cos(a.exact)))) << a.exact;
  }
}

TYPED_TEST(BallTest, LosesLittle) {
  test::Random random(7);
  for (int n = 0; n < draws; ++n) {
    const Ball<typename TypeParam::Real> a(random.uniform(0.5, 2)), b(random.uniform(0.5, 2));
    EXPECT_LE((a * b + a / b).radius, 16 * unit_roundoff<typename TypeParam::Real>);
  }
}

}  // namespace
}  // namespace needlework::audit
