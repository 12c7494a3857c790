// The levels of accuracy, and what each promises.
#include "needlework/accuracy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernels/first_contact.h"
#include "tests/kernels/precise_contact.h"
#include "tests/support/by_build.h"
#include "tests/support/collided_pair.h"
#include "tests/support/family_name.h"
#include "tests/support/pairs_csv.h"

namespace needlework::kernels {
namespace {

using test::KernelPair;
using test::NeedlePair;
using test::Quad;

constexpr std::size_t accuracy_count = test::by_build<std::size_t>(3000, 100);

Contact contact_of(const KernelPair& pair, double horizon, const Accuracy& accuracy) {
  EvaluationCounters counters;
  return first_contact(pair.view(), 0, horizon, counters, accuracy);
}

// The root of the records' own contact function next to this time, by Newton's iteration in 113
// bits; and by how much the noise of double-double may move it.
struct ExactTime {
  Quad time, noise;
};
ExactTime exact_time(const KernelPair& held, const DoubleDouble& near) {
  const Pair pair = held.view();
  const PairScale scale = scale_of(pair);
  const Quad start = held.touch.touching ? test::precise_contact(pair, scale, Quad(0)).f : Quad(0);
  Quad s = (Quad(near.hi) + Quad(near.lo)) * Quad(scale.per_time);
  Quad slope, size = 1;
  for (int i = 0; i < 4; ++i) {
    const auto here = test::precise_contact(pair, scale, s);
    slope = abs(here.df);
    s -= (here.f - start) / here.df;
    // f is as exact as it is small in both factors; f - f(0) only as f(0) is.
    if (!held.touch.touching) {
      size = test::norm(here.x) + test::norm(test::cross(here.u[0], here.r)) +
             test::norm(test::cross(here.u[1], here.r));
    }
  }
  const Quad unit = scale.per_rate;
  return {s * unit, Quad(0x1p-94) * size / slope * unit};
}

double units_off(const DoubleDouble& time, const ExactTime& exact) {
  const double unit = std::nextafter(time.hi, 2 * time.hi) - time.hi;
  return static_cast<double>(abs(Quad(time.hi) - exact.time) / Quad(unit));
}

class AccuracyLevels : public testing::TestWithParam<test::PairFamily> {};

TEST_P(AccuracyLevels, RigorousTimesAreExact) {
  double worst = 0, worst_standard = 0;
  std::size_t contacts = 0, in_noise = 0;
  for (const NeedlePair& drawn : test::draw_pairs(GetParam().name, accuracy_count, 41)) {
    const KernelPair pair = test::collided_pair(drawn);
    const Contact rigorous = contact_of(pair, drawn.horizon, rigorous_accuracy);
    const Contact standard = contact_of(pair, drawn.horizon, standard_accuracy);
    ASSERT_EQ(rigorous.found, standard.found) << test::csv_line(0, drawn);
    if (!rigorous.found || rigorous.unresolvable) continue;
    ++contacts;
    ASSERT_EQ(rigorous.side, standard.side);
    const ExactTime exact = exact_time(pair, rigorous.elapsed);
    // Returns within about 1e-6 lie so near to the touch before that this is all there is.
    // Nothing else does.
    if (!pair.touch.touching) {
      ASSERT_LE(exact.noise, Quad(0x1p-54) * exact.time);
    }
    if (exact.noise > Quad(0x1p-54) * exact.time) {
      ++in_noise;
      continue;
    }
    worst = std::max(worst, units_off(rigorous.elapsed, exact));
    worst_standard = std::max(worst_standard, units_off(standard.elapsed, exact));
    ASSERT_LE(worst, 2) << test::csv_line(0, drawn);
  }
  std::printf(
      "%-14.*s contacts %zu, %zu more in the noise of double-double, units in the last place: "
      "rigorous %.2f, standard %.3g\n",
      static_cast<int>(GetParam().name.size()), GetParam().name.data(), contacts, in_noise, worst,
      worst_standard);
  EXPECT_GT(contacts, accuracy_count / 20);
  if (GetParam().name != "back-to-rounding") {
    EXPECT_LE(in_noise, accuracy_count / 100);
  }
}

// Isolation by intervals with the rest as in `standard`: the same contacts.
TEST_P(AccuracyLevels, IsolationsAgree) {
  for (const NeedlePair& drawn : test::draw_pairs(GetParam().name, accuracy_count, 42)) {
    const KernelPair pair = test::collided_pair(drawn);
    const Contact one = contact_of(pair, drawn.horizon, standard_accuracy);
    const Contact two = contact_of(pair, drawn.horizon, {.isolation = Isolation::intervals});
    ASSERT_EQ(one.found, two.found) << test::csv_line(0, drawn);
    if (!one.found) continue;
    ASSERT_EQ(one.side, two.side);
    ASSERT_NEAR(one.elapsed.hi, two.elapsed.hi, 1e-11 * one.elapsed.hi) << test::csv_line(0, drawn);
  }
}

TEST_P(AccuracyLevels, EscalationCanBeOff) {
  EvaluationCounters counters;
  for (const NeedlePair& drawn : test::draw_pairs(GetParam().name, accuracy_count / 10, 43)) {
    const KernelPair pair = test::collided_pair(drawn);
    first_contact(pair.view(), 0, drawn.horizon, counters, fast_accuracy);
    first_contact(pair.view(), 0, drawn.horizon, counters,
                  {.isolation = Isolation::sampling, .escalation = Escalation::never});
  }
  EXPECT_EQ(counters.escalated, 0u);
  EXPECT_GT(counters.evaluated, 0u);
}

// The answer may not depend on from which time on the search looks.
TEST_P(AccuracyLevels, SkippingChangesNoBit) {
  const Accuracy accuracies[] = {
      fast_accuracy, rigorous_accuracy, {.isolation = Isolation::sampling}};
  for (const NeedlePair& drawn : test::draw_pairs(GetParam().name, accuracy_count / 10, 44)) {
    const KernelPair pair = test::collided_pair(drawn);
    for (const Accuracy& accuracy : accuracies) {
      const Contact whole = contact_of(pair, drawn.horizon, accuracy);
      if (!whole.found || whole.unresolvable) continue;
      EvaluationCounters counters;
      const Contact late =
          first_contact(pair.view(), 0.75 * whole.elapsed.hi, drawn.horizon, counters, accuracy);
      ASSERT_TRUE(late.found) << test::csv_line(0, drawn);
      ASSERT_EQ(late.elapsed, whole.elapsed) << test::csv_line(0, drawn);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, AccuracyLevels, testing::ValuesIn(test::pair_families()),
                         test::family_name);

TEST(Accuracy, AFinerRootToleranceGivesTimesCloser) {
  double off[3] = {};
  const double tolerance[3] = {1e-3, 1e-5, 0};
  // In debug builds too: few of these pairs need the last step.
  for (const NeedlePair& drawn : test::draw_pairs("thermal-k6", 30000, 45)) {
    const KernelPair pair = test::collided_pair(drawn);
    const Contact truth = contact_of(pair, drawn.horizon, rigorous_accuracy);
    if (!truth.found) continue;
    for (int i = 0; i < 3; ++i) {
      const Contact contact = contact_of(pair, drawn.horizon, {.root_tolerance = tolerance[i]});
      ASSERT_TRUE(contact.found);
      off[i] = std::max(off[i], std::abs(contact.elapsed.hi / truth.elapsed.hi - 1));
    }
  }
  EXPECT_LT(off[2], 1e-12);
  EXPECT_GT(off[1], 10 * off[2]);
  EXPECT_GT(off[0], 10 * off[1]);
  EXPECT_LT(off[0], 1e-3);
}

}  // namespace
}  // namespace needlework::kernels
