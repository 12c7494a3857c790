// The random numbers of one needle: exact bits, accuracy of the logarithm, independence.
#include "src/random/needle_random.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace needlework {
namespace {

double ulps_between(double a, double b) {
  const double spacing = std::nextafter(std::abs(b), INFINITY) - std::abs(b);
  return std::abs(a - b) / spacing;
}

TEST(NaturalLog, IsWithinTwoUlpOfTheTrueOne) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (int i = 0; i < 300000; ++i) {
    // Squared radii: mostly in (0, 1), some close to 0 and to 1.
    const double x = uniform(random);
    for (const double y : {x, x * x * 0x1p-90, 1 - x * 0x1p-20, 1 + x * 0x1p-20, 3 * x})
      worst = std::max(
          worst,
          ulps_between(natural_log(y), static_cast<double>(std::log(static_cast<long double>(y)))));
  }
  EXPECT_LE(worst, 2);
  EXPECT_GT(worst, 0.4) << "a perfect logarithm: the comparison is broken";
  EXPECT_EQ(natural_log(1), 0);
  EXPECT_EQ(natural_log(2), 0x1.62e42fefa39efp-1);
  EXPECT_EQ(natural_log(0.5), -0x1.62e42fefa39efp-1);
}

// The known answer of Random123's own kat_vectors for zero key and counter, which are those of
// needle 0, seed 0, block 0.
TEST(NeedleRandom, IsPhiloxWithTheSeedAsKey) {
  NeedleRandom random(0, 0);
  for (const std::uint64_t word :
       {0x16554d9eca36314cu, 0xdb20fe9d672d0fdcu, 0xd7e772cee186176bu, 0x7e68b68aec7ba23bu})
    EXPECT_EQ(random.uniform(), static_cast<double>(word >> 11) * 0x1p-53);
  const auto second_block = r123::Philox4x64()({{1, 0, 0, 0}}, {{0, 0}});
  EXPECT_EQ(random.uniform(), static_cast<double>(second_block[0] >> 11) * 0x1p-53);
  const auto other = r123::Philox4x64()({{0, 5, 0, 0}}, {{~std::uint64_t{0}, 0}});
  EXPECT_EQ(NeedleRandom(~std::uint64_t{0}, 5).uniform(),
            static_cast<double>(other[0] >> 11) * 0x1p-53);
}

TEST(NeedleRandom, IsAnotherForEachPurposeAndCount) {
  const auto words = r123::Philox4x64()({{0, 5, 7, 3}}, {{9, 0}});
  EXPECT_EQ(NeedleRandom(9, 5, RandomFor::kick, 7).uniform(),
            static_cast<double>(words[0] >> 11) * 0x1p-53);
  EXPECT_EQ(NeedleRandom(9, 5, RandomFor::initial_state, 0).uniform(),
            NeedleRandom(9, 5).uniform());
}

// What is drawn for one purpose must not change when another one is added.
TEST(NeedleRandom, KeepsTheNumbersOfPurposes) {
  EXPECT_EQ(static_cast<int>(RandomFor::boltzmann), 5);
  EXPECT_EQ(static_cast<int>(RandomFor::size), 6);
  const auto words = r123::Philox4x64()({{0, 5, 1, 6}}, {{9, 0}});
  EXPECT_EQ(NeedleRandom(9, 5, RandomFor::size, 1).bits(), words[0] >> 11);
}

// Tolerances: five standard errors.
TEST(NeedleRandom, ExponentialNumbersHaveMeanAndVarianceOne) {
  constexpr int count = 100000;
  double sum = 0, squares = 0;
  for (int n = 0; n < count; ++n) {
    const double x = NeedleRandom(4, n).exponential();
    ASSERT_GE(x, 0);
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / count, 1, 5 / std::sqrt(count));
  EXPECT_NEAR(squares / count, 2, 5 * std::sqrt(20.0 / count));
}

TEST(NeedleRandom, DirectionsHaveLengthOne) {
  for (std::uint64_t id = 0; id < 100000; ++id) {
    const auto u = NeedleRandom(3, id).direction();
    ASSERT_NEAR(u[0] * u[0] + u[1] * u[1] + u[2] * u[2], 1, 0x1p-50) << id;
  }
}

// Golden bits: they change only when the drawing is changed, never with machine or compiler.
TEST(NeedleRandom, GivesTheSameBitsOnEveryMachine) {
  NeedleRandom random(1, 2);
  EXPECT_EQ(random.uniform(), 0x1.3f9f2a51fae4dp-1);
  EXPECT_EQ(random.direction(),
            (std::array{-0x1.f50b910f78b8ap-1, 0x1.32d42259fd778p-4, -0x1.8876ac52ab341p-3}));
  EXPECT_EQ(random.normal(),
            (std::array{-0x1.2c733ddffe191p-3, 0x1.186670c913941p-1, 0x1.42f6b0b15f348p-2}));
}

}  // namespace
}  // namespace needlework
