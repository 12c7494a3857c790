// Sums that do not depend on the order of their terms.
#include "src/trajectory/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/real.h"

namespace needlework {
namespace {

using test::Random;
using test::Wide;

constexpr std::uint64_t seed = 1313;

double sum(const std::vector<double>& terms, double largest) {
  ExactSum total(largest);
  for (const double term : terms) total.add(term);
  return total.value();
}

std::vector<double> draw(Random& random, int count, double largest) {
  std::vector<double> terms;
  for (int i = 0; i < count; ++i) {
    terms.push_back(largest * random.uniform(-1, 1) * std::ldexp(1.0, -random.below(70)));
  }
  return terms;
}

double size_of(const std::vector<double>& terms) {
  double largest = 0;
  for (const double term : terms) largest = std::max(largest, std::abs(term));
  return largest;
}

void shuffle(std::vector<double>& terms, Random& random) {
  for (std::size_t i = terms.size(); i > 1; --i) {
    std::swap(terms[i - 1], terms[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
  }
}

TEST(ExactSum, DoesNotDependOnTheOrderOfItsTerms) {
  Random random(seed);
  for (int n = 0; n < 200; ++n) {
    std::vector<double> terms = draw(random, 1000, random.log_uniform(1e-200, 1e200));
    const double largest = size_of(terms), first = sum(terms, largest);
    for (int i = 0; i < 5; ++i) {
      shuffle(terms, random);
      ASSERT_EQ(sum(terms, largest), first) << "seed " << seed << ", sum " << n;
    }
  }
}

// The grid is 2^-60 of the power of two below the largest term; what lies between is cut off.
TEST(ExactSum, IsWithinOneGridPointForEachTerm) {
  Random random(seed);
  for (int n = 0; n < 200; ++n) {
    const std::vector<double> terms = draw(random, 1000, random.log_uniform(1e-200, 1e200));
    const double largest = size_of(terms);
    Wide exact = 0;
    for (const double term : terms) exact += term;
    const double computed = sum(terms, largest);
    const Wide allowed = Wide(1000) * largest * 0x1p-60 + abs(exact) * 0x1p-52;
    ASSERT_LE(abs(computed - exact), allowed) << "seed " << seed << ", sum " << n;
  }
}

TEST(ExactSum, IsExactOnItsGrid) {
  Random random(seed);
  for (int n = 0; n < 200; ++n) {
    std::vector<double> terms = {1.5};
    Wide exact = 1.5;
    for (int i = 0; i < 1000; ++i) {
      terms.push_back(std::floor(random.uniform(-0x1p40, 0x1p40)) * 0x1p-41);
      exact += terms.back();
    }
    ASSERT_TRUE(sum(terms, 1.5) == exact) << "seed " << seed << ", sum " << n;
  }
}

TEST(ExactSum, OfOppositeTermsIsZeroAndOfNegatedOnesNegated) {
  Random random(seed);
  std::vector<double> terms = draw(random, 1000, 3), negated;
  for (const double term : terms) negated.push_back(-term);
  EXPECT_EQ(sum(negated, 3), -sum(terms, 3));
  terms.insert(terms.end(), negated.begin(), negated.end());
  EXPECT_EQ(sum(terms, 3), 0);
  EXPECT_LT(sum({-1, -2, 0.5}, 2), 0);
  EXPECT_EQ(sum({-1, -2, 0.5}, 2), -2.5);
}

// Plain addition loses the ones beside 2^53 and more.
TEST(ExactSum, KeepsSmallTermsBesideCancellingLargeOnes) {
  EXPECT_EQ(sum({0x1p55, 1, -0x1p55, 1}, 0x1p55), 2);
  EXPECT_EQ(sum({0x1p59, 1, -0x1p59, -3}, 0x1p59), -2);
}

TEST(ExactSum, HoldsManyLargestTerms) {
  ExactSum positive(1.99), negative(1.99);
  for (int i = 0; i < 100000; ++i) {
    positive.add(1.99);
    negative.add(-1.99);
  }
  EXPECT_NEAR(positive.value() / 199000, 1, 1e-15);
  EXPECT_EQ(negative.value(), -positive.value());
}

TEST(ExactSum, PowersOfTwoScaleItExactly) {
  Random random(seed);
  const std::vector<double> terms = draw(random, 1000, 5);
  for (const int power : {-600, -60, 60, 600}) {
    std::vector<double> scaled;
    for (const double term : terms) scaled.push_back(std::ldexp(term, power));
    EXPECT_EQ(sum(scaled, std::ldexp(5.0, power)), std::ldexp(sum(terms, 5), power));
  }
}

TEST(ExactSum, OfPartsIsThatOfAll) {
  Random random(seed);
  const std::vector<double> terms = draw(random, 1000, 5);
  ExactSum all(5), part(5), rest(5);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    all.add(terms[i]);
    (i % 3 == 0 ? part : rest).add(terms[i]);
  }
  part.take(rest);
  EXPECT_EQ(part.value(), all.value());
}

TEST(ExactSum, OfNothingOrZerosIsZero) {
  EXPECT_EQ(sum({}, 1), 0);
  EXPECT_EQ(sum({0, 0, -0.0}, 0), 0);
  EXPECT_EQ(sum({DBL_TRUE_MIN, DBL_TRUE_MIN}, DBL_TRUE_MIN), 2 * DBL_TRUE_MIN);
}

}  // namespace
}  // namespace needlework
