// The filter of rods, on every instruction set: never after the first contact, and most pairs that
// do not meet ruled out.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/rod_contact.h"
#include "tests/kernels/drawn_simd_pairs.h"
#include "tests/support/pairs_csv.h"

namespace needlework::kernels {
namespace {

class BracketRods : public testing::TestWithParam<test::PairFamily> {};

TEST_P(BracketRods, IsNeverTooLate) {
  const test::PairFamily& family = GetParam();
  Random random(seed + 9);
  const std::size_t count = 4000 / thin;
  std::size_t contacts = 0, apart = 0, ruled_out = 0, overlaps = 0;
  for (const test::NeedlePair& drawn : draw_pairs(family.name, count, seed + 9)) {
    SimdPair pair = simd_pair(random, drawn, any_halves(random));
    pair.row[PairColumns::from] = 0;
    RodPair rods;
    static_cast<Pair&>(rods) = pair.pair.view();
    rods.touch = {};
    rods.distance = random.log_uniform(1e-4, 0.5);
    pair.row[PairColumns::distance] = static_cast<float>(rods.distance);
    EvaluationCounters work;
    const double until = pair.row[PairColumns::until] / pair.unit;
    const Contact truth = rod_contact(rods, 0, until, work);
    // As those do that have just collided as needles.
    overlaps += truth.overlap;
    if (truth.overlap) continue;
    for (const Isa isa : available()) {
      // One, or a few among which there is no other.
      const std::vector<PairRow> rows(1 + random.below(20), pair.row);
      test::PairTable table(rows);
      const float* from = table.view().column[PairColumns::from];
      near_kernels(isa).bracket_rods(pair.seeker, table.view(), rows.size());
      for (std::size_t n = 0; n < rows.size(); ++n) {
        ASSERT_EQ(from[n], from[0]) << name_of(isa);
      }
      if (truth.found) {
        ++contacts;
        ASSERT_LE(from[0] / pair.unit, truth.elapsed.hi)
            << "distance " << rods.distance << ", " << name_of(isa) << ", seed " << seed << "\n"
            << test::csv_line(0, drawn);
      } else {
        ++apart;
        ruled_out += std::isinf(from[0]);
      }
    }
  }
  EXPECT_GE(contacts, (count - overlaps) / 100);
  EXPECT_GE(static_cast<double>(ruled_out), 0.7 * static_cast<double>(apart));
}

INSTANTIATE_TEST_SUITE_P(Families, BracketRods, testing::ValuesIn(test::pair_families()),
                         test::family_name);

}  // namespace
}  // namespace needlework::kernels
