// Displacements and rotations of needles whose motion is known.
#include <cmath>
#include <set>

#include "tests/observe/observed.h"

namespace needlework::observe {
namespace {

TEST(Displacement, OfFreeFlightIsBallistic) {
  Observed observed(scene_with("displacement", 4, flying_box));
  observed.sample(flying(0), 0.0);
  Values values = observed.sample(flying(7), 7.0);
  // From time 0, when the needles are along z, and from now.
  EXPECT_EQ(values["lag"][0], 7);
  EXPECT_NEAR(values["parallel"][0], 28 * 28, 1e-10);
  EXPECT_NEAR(values["perpendicular"][0], 21 * 21, 1e-10);
  EXPECT_NEAR(values["p1"][0], std::cos(3.5), 1e-14);
  EXPECT_NEAR(values["p2"][0], 1.5 * std::pow(std::cos(3.5), 2) - 0.5, 1e-14);
  EXPECT_EQ(values["lag"][1], 0);
  EXPECT_EQ(values["parallel"][1], 0);
  EXPECT_NEAR(values["p1"][1], 1, 1e-14);
  for (std::size_t n = 2; n < 8; ++n) EXPECT_TRUE(std::isnan(values["lag"][n])) << n;
  EXPECT_TRUE(std::isnan(values["p1"][7]));
}

TEST(Displacement, KeepsFewReferencesSpreadOverTheRun) {
  Observed observed(scene_with("displacement", 4, flying_box));
  std::set<double> seen;
  for (int sample = 0; sample < 1000; ++sample) {
    std::vector<double> lags = observed.sample(flying(sample), double(sample))["lag"];
    std::erase_if(lags, [](double lag) { return std::isnan(lag); });
    ASSERT_EQ(lags.front(), sample) << "the start is always a reference";
    ASSERT_GE(lags.size(), std::min<std::size_t>(static_cast<std::size_t>(sample) + 1, 5));
    const double step = lags.size() > 1 ? lags[0] - lags[1] : 1;
    for (std::size_t n = 1; n < lags.size(); ++n) ASSERT_EQ(lags[n - 1] - lags[n], step);
    ASSERT_LE(lags.back(), step) << "the newest is near";
    seen.insert(lags.begin(), lags.end());
  }
  EXPECT_EQ(seen.size(), 1000u) << "every lag from 0 to the whole run";
}

}  // namespace
}  // namespace needlework::observe
