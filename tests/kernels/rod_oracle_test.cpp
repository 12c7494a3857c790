// The quick oracle of rods says what the one in quad says.
#include "tests/support/rod_oracle.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/rod_families.h"

namespace needlework::test {
namespace {

class QuickRodOracle : public testing::TestWithParam<RodFamily> {};

TEST_P(QuickRodOracle, SaysWhatAllDigitsSay) {
  Random random(21);
  constexpr int pairs = 40;
  for (int n = 0; n < pairs; ++n) {
    SCOPED_TRACE(n);
    const RodCase rods = GetParam().draw(random);
    const std::optional<RodAnswer> quick = quick_rod_contact(rods);
    if (!quick) continue;
    const RodAnswer full = first_rod_contact(rods);
    ASSERT_FALSE(full.undecided);
    ASSERT_EQ(quick->contact, full.contact) << static_cast<double>(full.time);
    EXPECT_LE(static_cast<double>(abs(quick->time - full.time)),
              1e-6 * static_cast<double>(full.time));
  }
}

TEST_P(QuickRodOracle, SettlesNearlyAll) {
  Random random(22);
  constexpr int pairs = 1000;
  int settled = 0;
  for (int n = 0; n < pairs; ++n) settled += quick_rod_contact(GetParam().draw(random)).has_value();
  // Nearly parallel rods that have just collided meet after a time that may be rounding.
  const bool is_hard = GetParam().name == "just_collided_parallel";
  EXPECT_GE(settled, (is_hard ? 0.97 : 0.99) * pairs);
}

// Spheres that pass each other by a trillionth, and by nothing.
TEST(QuickRodOracleAlone, LeavesWhatIsNotClearToMoreDigits) {
  RodCase spheres;
  spheres.first.u = spheres.second.u = {0, 0, 1};
  spheres.first.r = {0.25, -1, 0};
  spheres.first.v = {0, 1, 0};
  spheres.horizon = 3;
  spheres.pair.distance = 0.25 * (1 + 1e-12);
  const auto meets = quick_rod_contact(spheres);
  ASSERT_TRUE(meets);
  EXPECT_TRUE(meets->contact);
  EXPECT_NEAR(static_cast<double>(meets->time), 1, 1e-6);
  spheres.pair.distance = 0.25 * (1 - 1e-12);
  const auto passes = quick_rod_contact(spheres);
  ASSERT_TRUE(passes);
  EXPECT_FALSE(passes->contact);
  spheres.pair.distance = 0.25;
  EXPECT_FALSE(quick_rod_contact(spheres));
}

// It knows nothing of growth.
std::vector<RodFamily> families_of_one_size() {
  std::vector<RodFamily> out = rod_families();
  std::erase_if(out, [](const RodFamily& family) { return family.name.starts_with("growing"); });
  return out;
}

INSTANTIATE_TEST_SUITE_P(Families, QuickRodOracle, testing::ValuesIn(families_of_one_size()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace needlework::test
