// The filter of spheres: never after the first contact of the pair, and next to it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kernels/rod_contact.h"
#include "tests/kernels/simd_pairs.h"
#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

struct SpherePair {
  Flight first, second;
  Contact truth;
};

SpherePair draw_spheres(test::Random& random, double distance, double until) {
  SpherePair out;
  for (Flight* each : {&out.first, &out.second}) {
    each->r = {random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)};
    each->v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    each->u = {0, 0, 1};
  }
  // Half of them fly towards each other.
  if (random.coin()) out.first.v = out.second.v + (out.second.r - out.first.r) * random.uniform();
  RodPair pair;
  pair.first = &out.first;
  pair.second = &out.second;
  pair.half_first = pair.half_second = 0;
  pair.distance = distance;
  EvaluationCounters counters;
  out.truth = rod_contact(pair, 0, until, counters);
  return out;
}

TEST(BracketSpheres, GivesTheTimeOfTheFirstContactOnEveryInstructionSet) {
  test::Random random(4711);
  constexpr double distance = 0.75, until = 3;
  int met = 0, apart = 0;
  for (int n = 0; n < 2000; ++n) {
    const SpherePair drawn = draw_spheres(random, distance, until);
    if (drawn.truth.overlap) continue;
    const Seeker seeker = test::seeker_of(test::motion_of(drawn.first, 0, 1, 0), until, 0);
    const Motion other = test::motion_of(drawn.second, 0, 1, 0);
    // One pair, or one in a row of others.
    test::PairRow row = test::row_of(seeker, other, 0, static_cast<float>(until));
    row[PairColumns::distance] = distance;
    const std::vector<test::PairRow> rows(n % 3 == 0 ? 1 : 19, row);
    for (const Isa isa : available()) {
      test::PairTable table(rows);
      const PairColumns view = table.view();
      near_kernels(isa).bracket_spheres(seeker, view, rows.size());
      const std::vector<float> from(view.column[PairColumns::from],
                                    view.column[PairColumns::from] + rows.size());
      for (const float each : from) ASSERT_EQ(each, from.front()) << name_of(isa);
      if (drawn.truth.found) {
        ++met;
        const double time = drawn.truth.elapsed.hi;
        ASSERT_LE(from.front(), time) << name_of(isa);
        // Spheres that graze enter the margins long before.
        const double speed =
            std::sqrt(dot(drawn.first.v - drawn.second.v, drawn.first.v - drawn.second.v));
        ASSERT_GE(from.front(), time - 0.15 / speed) << n << ", " << name_of(isa);
      } else {
        apart += from.front() == std::numeric_limits<float>::infinity();
      }
    }
  }
  const auto sets = static_cast<int>(available().size());
  EXPECT_GT(met, 500 * sets);
  EXPECT_GT(apart, 400 * sets);
}

}  // namespace
}  // namespace needlework::kernels
