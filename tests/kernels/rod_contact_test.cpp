// First contacts of rods of finite width, against an oracle that knows nothing of the kernel.
#include "kernels/rod_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "src/physics/director.h"
#include "tests/support/random.h"
#include "tests/support/rod_families.h"
#include "tests/support/rod_oracle.h"

namespace needlework::kernels {
namespace {

using test::Quad;
using test::Random;
using test::RodAnswer;
using test::RodCase;
using test::RodFamily;

Contact rods_meet(const RodCase& rods, const Accuracy& accuracy = standard_accuracy) {
  EvaluationCounters counters;
  return rod_contact(rods.view(), 0, rods.horizon, counters, accuracy);
}

Quad time_of_rods(const Contact& contact) {
  return Quad(contact.elapsed.hi) + Quad(contact.elapsed.lo);
}

void expect_same_contact(const Contact& a, const Contact& b) {
  EXPECT_EQ(a.found, b.found);
  EXPECT_EQ(a.elapsed, b.elapsed);
  EXPECT_EQ(a.side, b.side);
  EXPECT_EQ(a.overlap, b.overlap);
  EXPECT_EQ(a.unresolvable, b.unresolvable);
}

class RodContactFamily : public testing::TestWithParam<RodFamily> {};

TEST_P(RodContactFamily, IsThatOfTheOracle) {
  Random random(1);
  constexpr int pairs = 60;
  int contacts = 0, undecided = 0;
  for (int n = 0; n < pairs; ++n) {
    SCOPED_TRACE(n);
    const RodCase rods = GetParam().draw(random);
    const RodAnswer truth = first_rod_contact(rods);
    const Contact found = rods_meet(rods);
    if (truth.undecided) {
      ++undecided;
      continue;
    }
    ASSERT_FALSE(found.overlap);
    ASSERT_EQ(found.found, truth.contact) << static_cast<double>(truth.time);
    if (!truth.contact) continue;
    ++contacts;
    // Of rods that touch at s = 0, the oracle looks from a time on that is 1e-27 of this unit.
    const double unit = rods.horizon;
    EXPECT_LE(static_cast<double>(abs(time_of_rods(found) - truth.time)),
              1e-13 * static_cast<double>(truth.time) + 1e-25 * unit);
  }
  EXPECT_LE(undecided, pairs / 10);
  RecordProperty("contacts", contacts);
}

TEST_P(RodContactFamily, DoesNotDependOnTheOrderOfTheRods) {
  Random random(2);
  for (int n = 0; n < 200; ++n) {
    const RodCase rods = GetParam().draw(random), other = rods.exchanged();
    const Contact found = rods_meet(rods);
    expect_same_contact(found, rods_meet(other));
    EXPECT_EQ(rod_time_apart(rods.view()), rod_time_apart(other.view()));
    const DoubleDouble then = found.found ? found.elapsed : DoubleDouble(0.3 * rods.horizon);
    EXPECT_EQ(rod_gap(rods.view(), then), rod_gap(other.view(), then));
    const ContactGeometry a = rod_geometry(rods.view(), then), b = rod_geometry(other.view(), then);
    EXPECT_EQ(a.u_first, b.u_second);
    EXPECT_EQ(a.u_second, b.u_first);
    EXPECT_EQ(a.normal, -b.normal);
    EXPECT_EQ(a.arm_first, b.arm_second);
    EXPECT_EQ(a.arm_second, b.arm_first);
    EXPECT_EQ(a.sin_angle, b.sin_angle);
  }
}

TEST_P(RodContactFamily, DoesNotDependOnWhenItIsAskedFor) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const RodCase rods = GetParam().draw(random);
    const Contact found = rods_meet(rods);
    const double latest = found.found ? found.elapsed.hi : rods.horizon;
    EvaluationCounters counters;
    for (const double share : {0.1, 0.5, 0.99, 1.0}) {
      expect_same_contact(rod_contact(rods.view(), share * latest, rods.horizon, counters), found);
    }
    if (!found.found || found.elapsed.hi == 0) continue;
    expect_same_contact(rod_contact(rods.view(), 0, found.elapsed.hi, counters), found);
    EXPECT_FALSE(rod_contact(rods.view(), 0, found.elapsed.hi * (1 - 1e-9), counters).found);
    if (rods.pair.touch.collided) {
      EXPECT_LE(rod_time_apart(rods.view()), found.elapsed.hi);
    }
  }
}

TEST_P(RodContactFamily, IsAtTheDistanceOfContact) {
  Random random(4);
  for (int n = 0; n < 200; ++n) {
    const RodCase rods = GetParam().draw(random);
    const Contact found = rods_meet(rods);
    if (!found.found) continue;
    const double scale = rods.pair.half_first + rods.pair.half_second + rods.pair.distance;
    EXPECT_LE(std::abs(rod_gap(rods.view(), found.elapsed)), 1e-11 * scale);
    const ContactGeometry at = rod_geometry(rods.view(), found.elapsed);
    EXPECT_NEAR(dot(at.normal, at.normal), 1, 1e-15);
    EXPECT_LE(std::abs(at.arm_first), rods.pair.half_first);
    EXPECT_LE(std::abs(at.arm_second), rods.pair.half_second);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, RodContactFamily, testing::ValuesIn(test::rod_families()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace needlework::kernels
