// Exact sums of positive numbers of any size.
#include "src/trajectory/exact_total.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <string>
#include <vector>

#include "src/archive/archive.h"
#include "tests/support/random.h"
#include "tests/support/real.h"

namespace needlework {
namespace {

using test::Random;

constexpr std::uint64_t total_seed = 4711;

ExactTotal total_of(const std::vector<double>& terms) {
  ExactTotal total;
  for (const double term : terms) total.add(term);
  return total;
}

std::vector<double> positive_terms(Random& random, int count, double least, double largest) {
  std::vector<double> terms;
  terms.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) terms.push_back(random.log_uniform(least, largest));
  return terms;
}

// Terms of one size have a sum that wide numbers hold exactly.
TEST(ExactTotal, IsTheSumRoundedOnce) {
  Random random(total_seed);
  for (int n = 0; n < 200; ++n) {
    const double scale = random.log_uniform(1e-300, 1e290);
    const auto terms = positive_terms(random, 1000, scale, 1e5 * scale);
    test::Wide exact = 0;
    for (const double term : terms) exact += term;
    ASSERT_EQ(total_of(terms).value(), static_cast<double>(exact))
        << "seed " << total_seed << ", " << n;
  }
}

TEST(ExactTotal, DoesNotDependOnOrderAndGrouping) {
  Random random(total_seed);
  auto terms = positive_terms(random, 3000, 1e-300, 1e300);
  const double whole = total_of(terms).value();
  std::reverse(terms.begin(), terms.end());
  EXPECT_EQ(total_of(terms).value(), whole);
  ExactTotal all;
  for (std::size_t begin = 0; begin < terms.size(); begin += 1000) {
    ExactTotal part = total_of({terms.begin() + static_cast<std::ptrdiff_t>(begin),
                                terms.begin() + static_cast<std::ptrdiff_t>(begin + 1000)});
    all.take(part);
  }
  EXPECT_EQ(all.value(), whole);
}

TEST(ExactTotal, KeepsSmallTermsBesideLargeOnes) {
  std::vector<double> terms(1024, 0x1p-43);
  terms.push_back(0x1p20);
  EXPECT_EQ(total_of(terms).value(), 0x1p20 + 0x1p-33);  // one by one, they would be lost
  EXPECT_EQ(total_of({0x1p53, 1, 0x1p-1074}).value(), 0x1p53 + 2);  // just above a half: up
  EXPECT_EQ(total_of({0x1p53, 1}).value(), 0x1p53);                 // a half: to even
}

TEST(ExactTotal, TakesTheSmallestAndTheLargestNumbers) {
  EXPECT_EQ(ExactTotal{}.value(), 0);
  EXPECT_EQ(total_of({0, 0x1p-1074, 0x1p-1074, DBL_MIN}).value(), DBL_MIN + 0x1p-1073);
  EXPECT_EQ(total_of({DBL_MAX}).value(), DBL_MAX);
  EXPECT_EQ(total_of({DBL_MAX, DBL_MAX}).value(), HUGE_VAL);
}

TEST(ExactTotal, IsSavedAndRestored) {
  Random random(total_seed);
  ExactTotal total = total_of(positive_terms(random, 1000, 1e-300, 1e300)), again;
  std::string bytes;
  Archive writing = Archive::to(bytes);
  writing(total);
  Archive reading = Archive::from(bytes);
  reading(again);
  reading.require_end();
  EXPECT_EQ(again.value(), total.value());
  total.add(1e299);
  again.add(1e299);
  EXPECT_EQ(again.value(), total.value());
}

// Digits that carry() would never have left.
TEST(ExactTotal, IsNotRestoredFromDamagedBytes) {
  ExactTotal total;
  std::string bytes;
  Archive writing = Archive::to(bytes);
  writing(total);
  bytes[7] = 1;
  Archive reading = Archive::from(bytes);
  EXPECT_ANY_THROW(reading(total));
}

}  // namespace
}  // namespace needlework
