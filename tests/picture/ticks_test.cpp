#include "src/picture/ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace needlework::picture {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> labels;
  for (const Tick& tick : ticks) labels.push_back(tick.label);
  return labels;
}

using Labels = std::vector<std::string>;

TEST(Ticks, AreMultiplesOfOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_EQ(labels(ticks({0, 1}, false, 5)), (Labels{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(ticks({-3.1, 2.9}, false, 6)), (Labels{"−3", "−2", "−1", "0", "1", "2"}));
  EXPECT_EQ(labels(ticks({0, 230}, false, 5)), (Labels{"0", "50", "100", "150", "200"}));
  EXPECT_EQ(labels(ticks({0.95, 1.05}, false, 5)),
            (Labels{"0.96", "0.98", "1.00", "1.02", "1.04"}));
}

TEST(Ticks, OfVeryLargeAndVerySmallNumbersHaveAPower) {
  EXPECT_EQ(labels(ticks({0, 4e7}, false, 4)), (Labels{"0", "10⁷", "2·10⁷", "3·10⁷", "4·10⁷"}));
  EXPECT_EQ(labels(ticks({0, 3e-9}, false, 3)), (Labels{"0", "10⁻⁹", "2·10⁻⁹", "3·10⁻⁹"}));
  // The digits in which neighbours differ are there.
  EXPECT_EQ(labels(ticks({1e6, 1e6 + 2}, false, 2)),
            (Labels{"1.000000·10⁶", "1.000001·10⁶", "1.000002·10⁶"}));
}

TEST(Ticks, OfLogarithmicAxesAreDecadesOrPartsOfThem) {
  EXPECT_EQ(labels(ticks({1e-3, 1}, true, 5)), (Labels{"0.001", "0.01", "0.1", "1"}));
  EXPECT_EQ(labels(ticks({1e-11, 1}, true, 6)),
            (Labels{"10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "1"}));
  EXPECT_EQ(labels(ticks({1, 30}, true, 5)), (Labels{"1", "2", "5", "10", "20"}));
}

TEST(Ticks, OfLessThanADecadeAreLinear) {
  EXPECT_EQ(labels(ticks({3, 5}, true, 4)), (Labels{"3.0", "3.5", "4.0", "4.5", "5.0"}));
}

TEST(Ticks, AreInTheRangeAndNotTooManyWhateverTheRange) {
  for (const bool logarithmic : {false, true}) {
    for (const double low : {1e-300, 1e-30, 0.07, 1.0, 333.0, 1e30, 1e140}) {
      for (const double ratio : {1 + 1e-11, 1.001, 1.7, 1e3, 1e14, 1e200}) {
        const Range range = usable_range({low, low * ratio}, logarithmic);
        const std::vector<Tick> all = ticks(range, logarithmic, 5);
        EXPECT_GE(labels(all).size(), 1) << low << " " << ratio << " " << logarithmic;
        EXPECT_LE(labels(all).size(), 10) << low << " " << ratio << " " << logarithmic;
        for (const Tick& tick : all) {
          EXPECT_GE(tick.value, range.low - 1e-5 * (range.high - range.low));
          EXPECT_LE(tick.value, range.high + 1e-5 * (range.high - range.low));
        }
      }
    }
  }
}

TEST(Ranges, CoverWhatCanBePlaced) {
  RangeOfValues values(false);
  values.add({nan, 3, infinity, -1, -infinity});
  EXPECT_EQ(values.range().low, -1);
  EXPECT_EQ(values.range().high, 3);
  EXPECT_EQ(values.range(0.25).low, -2);
  RangeOfValues positive(true);
  positive.add({0, -5, 10, 1000, nan});
  EXPECT_EQ(positive.range().low, 10);
  EXPECT_EQ(positive.range().high, 1000);
  EXPECT_NEAR(positive.range(0.5).low, 1, 1e-12);
}

TEST(Ranges, AreUsableEvenWithoutValues) {
  for (const bool logarithmic : {false, true}) {
    for (const std::vector<double>& values :
         {std::vector<double>{}, {nan}, {-1}, {0}, {1}, {1, 1}, {1e308, -1e308}, {5e-324, 1e308}}) {
      RangeOfValues all(logarithmic);
      all.add(values);
      for (const double margin : {0.0, 0.05}) {
        const Range range = all.range(margin);
        EXPECT_LT(range.low, range.high);
        EXPECT_TRUE(std::isfinite(range.high - range.low));
        if (logarithmic) {
          EXPECT_GT(range.low, 0);
        }
      }
    }
  }
}

TEST(Scales, MapTheEndsOfTheirRange) {
  const Scale linear{{-1, 3}, false, 0, 400};
  EXPECT_EQ(linear(-1), 0);
  EXPECT_EQ(linear(0), 100);
  EXPECT_EQ(linear(3), 400);
  const Scale logarithmic{{1e-2, 1e2}, true, 300, 100};
  EXPECT_EQ(logarithmic(1e-2), 300);
  EXPECT_NEAR(logarithmic(1), 200, 1e-9);
  EXPECT_NEAR(logarithmic(1e2), 100, 1e-9);
}

TEST(Scales, HaveNoPlaceForWhatIsNotFiniteOrNotPositiveOnALogarithmicAxis) {
  const Scale linear{{0, 1}, false, 0, 100}, logarithmic{{1, 10}, true, 0, 100};
  for (const double value : {nan, infinity, -infinity}) {
    EXPECT_TRUE(std::isnan(linear(value)));
    EXPECT_TRUE(std::isnan(logarithmic(value)));
  }
  EXPECT_TRUE(std::isnan(logarithmic(0)));
  EXPECT_TRUE(std::isnan(logarithmic(-1)));
  EXPECT_TRUE(std::isfinite(linear(1.7e308)));
}

}  // namespace
}  // namespace needlework::picture
