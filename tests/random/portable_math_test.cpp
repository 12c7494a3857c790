// Logarithm and exponential with the same bits everywhere, against those with more digits.
#include "src/random/portable_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include "tests/support/real.h"

namespace needlework {
namespace {

using test::Quad;

Quad exactly(const DoubleDouble& x) { return Quad(x.hi) + Quad(x.lo); }

// The largest errors of a function: that of the double-double, relative, and that of its double, in
// units of the last place.
struct Worst {
  double relative = 0, ulps = 0;

  void add(const DoubleDouble& got, const Quad& wanted) {
    if (wanted == 0) {
      EXPECT_EQ(got.hi, 0);
      return;
    }
    relative = std::max(relative, std::abs(static_cast<double>(exactly(got) / wanted - 1)));
    const double size = std::abs(static_cast<double>(wanted));
    const double spacing = std::nextafter(size, INFINITY) - size;
    ulps = std::max(ulps, std::abs(static_cast<double>(Quad(to_double(got)) - wanted)) / spacing);
  }
  void expect_rounded() const {
    EXPECT_LE(relative, 0x1p-56);
    EXPECT_LE(ulps, 0.6);
    EXPECT_GT(ulps, 0.49) << "better than rounding: the comparison is broken";
  }
};

class PortableMath : public testing::Test {
 protected:
  double uniform() { return uniform_(random_); }
  static constexpr int count = 20000;

 private:
  std::mt19937_64 random_{7};
  std::uniform_real_distribution<double> uniform_{0, 1};
};

TEST_F(PortableMath, LogarithmIsThatOfManyDigitsRounded) {
  Worst worst, worst_of_one_plus;
  for (int n = 0; n < count; ++n) {
    const double u = 1 - uniform();
    for (const double x : {u, u * u * 0x1p-90, 1 - u * 0x1p-20, 1 + u * 0x1p-20, 3 * u,
                           std::exp(1400 * (u - 0.5))}) {
      worst.add(portable::log(x), log(Quad(x)));
    }
    for (const double x : {u * 1e-9, 0.3 * (2 * u - 1), 1e5 * u, u - 1 + 0x1p-40}) {
      worst_of_one_plus.add(portable::log1p(x), log(1 + Quad(x)));
    }
  }
  worst.expect_rounded();
  worst_of_one_plus.expect_rounded();
  EXPECT_EQ(portable::log(1), DoubleDouble(0));
}

TEST_F(PortableMath, ExponentialIsThatOfManyDigitsRounded) {
  Worst worst, worst_minus_one;
  for (int n = 0; n < count; ++n) {
    const double u = uniform();
    for (const double x : {2 * u - 1, 1400 * (u - 0.5), 20 * (u - 0.5), u * 1e-5, 0.35 * u}) {
      worst.add(portable::exp(x), exp(Quad(x)));
      worst_minus_one.add(portable::expm1(x), exp(Quad(x)) - 1);
    }
  }
  worst.expect_rounded();
  worst_minus_one.expect_rounded();
  EXPECT_EQ(portable::exp(0), DoubleDouble(1));
  EXPECT_EQ(portable::exp(-709), DoubleDouble(0));
}

TEST_F(PortableMath, TakesTheLowPartsOfArguments) {
  const DoubleDouble x(1.5, 0x1p-54);
  Worst worst;
  worst.add(portable::log(x), log(exactly(x)));
  worst.add(portable::exp(x), exp(exactly(x)));
  worst.add(portable::log1p(x), log(1 + exactly(x)));
  worst.add(portable::expm1(x), exp(exactly(x)) - 1);
  EXPECT_LE(worst.relative, 0x1p-56);
}

// Golden bits: they are the same with every machine and compiler.
TEST_F(PortableMath, GivesTheSameBitsOnEveryMachine) {
  std::uint64_t hash = 0;
  const auto mix = [&](const DoubleDouble& x) {
    for (const double part : {x.hi, x.lo})
      hash = (hash ^ std::bit_cast<std::uint64_t>(part)) * 0x100000001b3;
  };
  for (int n = 1; n <= 1000; ++n) {
    const double x = n * 0.01;
    mix(portable::log(x));
    mix(portable::log1p(x));
    mix(portable::exp(x - 5));
    mix(portable::expm1(x - 5));
  }
  EXPECT_EQ(hash, 15325546571583180940u);
}

}  // namespace
}  // namespace needlework
