// Distribution functions and their inverses, against values of 20 digits.
#include "src/random/probability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace needlework {
namespace {

Probability below(double u) { return {u, 1 - u}; }
Probability above(double u) { return {1 - u, u}; }

double difference(double a, double b) { return std::abs(a / b - 1); }

TEST(Probability, OfBitsIsExactAndNeverZeroOrOne) {
  constexpr std::uint64_t last = (std::uint64_t{1} << 53) - 1;
  EXPECT_EQ(Probability::of_bits(0).below, 0x1p-54);
  EXPECT_EQ(Probability::of_bits(0).above, 1);
  EXPECT_EQ(Probability::of_bits(last).above, 0x1p-54);
  EXPECT_EQ(Probability::of_bits(last).below, 1);
  EXPECT_EQ(Probability::of_bits(last / 2).below, 0.5 - 0x1p-54);
  EXPECT_EQ(Probability::of_bits(last / 2 + 1).above, 0.5 - 0x1p-54);
}

// Computed with 40 digits.
TEST(NormalQuantile, IsAccurateInBothTails) {
  struct Row {
    double u, z;
  };
  for (const auto& [u, z] : {Row{1e-12, -7.0344838253011317},
                             {1e-6, -4.7534243088228991},
                             {0.01, -2.3263478740408411},
                             {0.25, -0.67448975019608174}}) {
    EXPECT_LT(difference(normal_quantile(below(u)), z), 8e-16) << u;
    EXPECT_EQ(normal_quantile(above(u)), -normal_quantile(below(u)));
  }
  EXPECT_EQ(normal_quantile({0.5, 0.5}), 0);
}

TEST(NormalProbability, IsThatOfTheErrorFunctionInBothTails) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (int n = 0; n < 20000; ++n) {
    const double z = (n % 2 == 0 ? 37 : 3) * uniform(random);
    const double tail =
        static_cast<double>(std::erfc(static_cast<long double>(z) / std::sqrt(2.0L)) / 2);
    worst = std::max(worst, difference(normal_probability(z).above, tail));
    ASSERT_EQ(normal_probability(-z).below, normal_probability(z).above);
  }
  EXPECT_LT(worst, 1e-15);
  EXPECT_EQ(normal_probability(INFINITY).below, 1);
  EXPECT_EQ(normal_probability(-INFINITY).above, 1);
  EXPECT_NEAR(normal_probability(0).below, 0.5, 1e-16);
}

TEST(NormalProbability, IsTheInverseOfTheQuantile) {
  for (int n = 1; n < 300; ++n) {
    const double z = -0.025 * n;
    EXPECT_LT(difference(normal_quantile(normal_probability(z)), z), 1e-14) << z;
  }
}

// The smaller of P(shape, shape x) for x < 1 and Q for others, computed with 40 digits.
struct GammaRow {
  double shape, x, tail;
};
constexpr GammaRow gamma_rows[] = {
    {0.5, 1e-07, 0.00025231324799679519216},
    {0.5, 0.001, 0.02522712063003961172},
    {0.5, 0.292893, 0.41162743543784958206},
    {0.5, 1.0, 0.31731050786291410283},
    {0.5, 1.70711, 0.1913607629579948996},
    {0.5, 5.24264, 0.022039803985687302058},
    {0.5, 12.3137, 0.00044964576513816985603},
    {1.0, 1e-07, 9.9999995000000162141e-8},
    {1.0, 0.001, 0.00099950016662500835274},
    {1.0, 0.5, 0.3934693402873665764},
    {1.0, 1.0, 0.3678794411714423216},
    {1.0, 1.5, 0.22313016014842982893},
    {1.0, 4.0, 0.018315638888734180294},
    {1.0, 9.0, 0.0001234098040866795495},
    {2.777, 1e-07, 1.35887574994102884e-19},
    {2.777, 0.001, 1.7389743656435951955e-8},
    {2.777, 0.699958, 0.36150717048804930302},
    {2.777, 1.0, 0.42017264604763682649},
    {2.777, 1.30004, 0.25645877753599423067},
    {2.777, 2.80025, 0.012213103496077632489},
    {2.777, 5.80067, 9.5622625772535421959e-6},
    {11.11111111111111, 1e-07, 1.3258396791014226016e-74},
    {11.11111111111111, 0.1, 2.2288038284173811858e-8},
    {11.11111111111111, 0.85, 0.33507580986231370935},
    {11.11111111111111, 1.0, 0.46008988177034602314},
    {11.11111111111111, 1.15, 0.28230554126623742616},
    {11.11111111111111, 1.9, 0.0063982407801556995797},
    {11.11111111111111, 3.4, 9.9424133564387852852e-8},
    {1000.0, 0.778641, 1.6650138064376312864e-14},
    {1000.0, 0.905132, 0.0010012765770684501527},
    {1000.0, 0.984189, 0.3113270611180784257},
    {1000.0, 1.0, 0.4957947558197844915},
    {1000.0, 1.01581, 0.30577130167769245291},
    {1000.0, 1.09487, 0.0017469666655040330155},
    {1000.0, 1.25298, 5.8338847591848850699e-14},
    {1000000.0, 0.993, 1.1410047078310705064e-12},
    {1000000.0, 0.997, 0.0013381041673135879543},
    {1000000.0, 0.9995, 0.30862555689083471707},
    {1000000.0, 1.0, 0.49986701923912740876},
    {1000000.0, 1.0005, 0.30844952422852219679},
    {1000000.0, 1.003, 0.001361740646218074587},
    {1000000.0, 1.008, 7.3702785796048337451e-16},
};

TEST(GammaLaw, HasTheIncompleteGammaFunction) {
  for (const auto& [shape, x, tail] : gamma_rows) {
    const Probability got = GammaLaw(shape).probability(x);
    EXPECT_LT(difference(x < 1 ? got.below : got.above, tail), 1e-15) << shape << ", " << x;
    EXPECT_NEAR(got.below + got.above, 1, 0x1p-52);
  }
  EXPECT_EQ(GammaLaw(2).probability(0).below, 0);
  EXPECT_EQ(GammaLaw(2).probability(INFINITY).above, 0);
}

TEST(GammaLaw, HasTheInverse) {
  for (const auto& [shape, x, tail] : gamma_rows) {
    if (shape < 1) continue;
    const Probability u = x < 1 ? below(tail) : above(tail);
    if (u.smaller() != tail) continue;  // of the other tail, u has not all digits
    EXPECT_LT(difference(GammaLaw(shape).quantile(u), x), 5e-16) << shape << ", " << x;
  }
}

// Width 0.3, computed independently.
TEST(GammaLaw, HasQuantilesOfDecimals) {
  const GammaLaw law(1 / (0.3 * 0.3));
  EXPECT_LT(difference(law.quantile(below(1e-12)), 0.038392995216562411551), 5e-16);
  EXPECT_LT(difference(law.quantile(below(1e-6)), 0.14696351669098662311), 5e-16);
  EXPECT_LT(difference(law.quantile(below(0.01)), 0.43591439424365783785), 5e-16);
  EXPECT_LT(difference(law.quantile(below(0.25)), 0.784750423107638342), 5e-16);
  EXPECT_LT(difference(law.quantile(below(0.5)), 0.97016529244193305816), 5e-16);
  EXPECT_LT(difference(law.quantile(above(0.1)), 1.3985511684042198755), 5e-16);
  EXPECT_LT(difference(law.quantile(above(1e-3)), 2.1867004349584813063), 5e-16);
  EXPECT_LT(difference(law.quantile(above(1e-6)), 3.1155060135335972421), 5e-16);
}

// Shape 1 is the exponential distribution.
TEST(GammaLaw, OfShapeOneIsExponential) {
  const GammaLaw exponential(1);
  for (const double x : {1e-16, 1e-3, 0.5, 0.7, 1.0, 3.0, 36.0}) {
    EXPECT_LT(
        difference(exponential.quantile(x < 0.6 ? below(-std::expm1(-x)) : above(std::exp(-x))), x),
        5e-16)
        << x;
  }
}

TEST(GammaLaw, IsItsOwnInverseForAllShapes) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int n = 0; n < 3000; ++n) {
    const double shape = std::pow(10.0, 6 * uniform(random));
    const Probability u = n % 2 == 0 ? below(std::exp(-37 * uniform(random)) / 2)
                                     : above(std::exp(-37 * uniform(random)) / 2);
    const GammaLaw law(shape);
    const Probability back = law.probability(law.quantile(u));
    // A rounding of x changes the logarithm of a probability by some 40 in the tail of shape 1, and
    // by some ten roots of a large shape.
    const double tolerance = 1e-14 + 2e-15 * std::sqrt(shape);
    ASSERT_LT(u.is_lower() ? difference(back.below, u.below) : difference(back.above, u.above),
              tolerance)
        << shape << ", " << u.below;
  }
}

TEST(GammaLaw, HasMoments) {
  for (const double shape : {1.0, 3.7, 100 / 9.0, 1e6}) {
    const GammaLaw law(shape);
    EXPECT_LT(difference(law.moment(1), 1), 4e-16) << shape;
    EXPECT_LT(difference(law.moment(2), 1 + 1 / shape), 4e-16) << shape;
    EXPECT_LT(
        difference(law.moment(0.5) * GammaLaw(shape + 0.5).moment(0.5) * std::sqrt(1 + 0.5 / shape),
                   1),
        4e-16)
        << shape;
  }
}

}  // namespace
}  // namespace needlework
