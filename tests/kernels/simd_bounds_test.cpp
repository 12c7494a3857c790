// What the SIMD kernels say of a pair on every instruction set: values within their bounds, never a
// contact lost, whatever the lengths and speeds, and most pairs that do not meet ruled out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/kernels/drawn_simd_pairs.h"
#include "tests/support/oracle.h"
#include "tests/support/pairs_csv.h"
#include "tests/support/segments.h"

namespace needlework::kernels {
namespace {

using test::bracketed;
using test::vec3;

class SimdContactFunction : public testing::TestWithParam<test::PairFamily> {};

// Against double-double, wherever the bounding spheres overlap; with the reserve that the kernels
// claim.
void expect_within_bounds(const test::PairFamily& family, bool any_lengths) {
  using C = ContactColumns;
  Random random(seed);
  const std::size_t count = (family.thermal ? 50000 : 10000) / thin / (any_lengths ? 2 : 1);
  std::size_t near = 0;
  double worst[4] = {}, most_gap = 0;
  for (const test::NeedlePair& drawn : draw_pairs(family.name, count, seed + 2)) {
    const SimdPair pair = simd_pair(random, drawn, any_lengths ? any_halves(random) : Halves{});
    const Halves halves = pair.halves();
    const auto s = static_cast<float>(random.uniform()) * pair.row[PairColumns::until];
    const auto frame = make_frame<DoubleDouble>(pair.pair.view(), {true, 1 / pair.unit, pair.unit});
    const DoubleDouble at(static_cast<double>(s));
    const Sample<DoubleDouble> exact = evaluate(frame, at);
    const Vec3d r = to_double(exact.r);
    const double phase = to_double(frame.omega[0]) * s +
                         to_double(frame.omega[1]) * (s + pair.row[PairColumns::age]);
    const double reach = halves.first + halves.second;
    if (dot(r, r) > reach * reach || phase > 0x1p11) continue;
    ++near;
    // The third derivative as a quotient of differences, off by 1e-18 of its bound.
    const DoubleDouble step(1e-9 / (frame.v_norm + frame.w_sum));
    const DoubleDouble third =
        (evaluate(frame, at + step).ddf - evaluate(frame, at - step).ddf) / (step + step);
    const double expected[] = {to_double(exact.f), to_double(exact.df), to_double(exact.ddf),
                               to_double(third)};
    const Vec3d gap = test::nearest_points(r, to_double(exact.u[0]), Vec3d{}, to_double(exact.u[1]),
                                           halves.first, halves.second)
                          .gap;
    const double length = std::sqrt(dot(gap, gap));
    for (const Isa isa : available()) {
      const auto got = test::contact_functions(near_kernels(isa), pair.seeker, {pair.row}, s)[0];
      const auto message = [&] {
        return std::string(name_of(isa)) + " at " + std::to_string(s) + ", seed " +
               std::to_string(seed) + "\n" + test::csv_line(0, drawn);
      };
      for (int n = 0; n < 4; ++n) {
        const double error = std::abs(got[C::f + n] - expected[n]), bound = got[C::error_f + n];
        ASSERT_LE(error, bound / 4) << "derivative " << n << ", " << message();
        if (error > 0) worst[n] = std::max(worst[n], error / bound);
      }
      // A gap that is too long is one between other points than the nearest, off by what a rough
      // guess of them adds to its square.
      const double margin = got[C::error_f] / 4, guess = isa == Isa::scalar ? 0 : 0x1p-12;
      ASSERT_GE(got[C::gap], length - margin) << message();
      ASSERT_LE(got[C::gap],
                std::hypot(length + margin, guess) * (isa == Isa::scalar ? 1 : 1 + 0x1p-10))
          << message();
      most_gap = std::max(most_gap, std::abs(got[C::gap] - length));
    }
  }
  std::printf("of %zu: errors up to %.2f, %.2f, %.2f, %.2f of their bounds, that of the gap %.1e\n",
              near, worst[0], worst[1], worst[2], worst[3], most_gap);
  EXPECT_GT(near, count / 20);
}

TEST_P(SimdContactFunction, IsWithinBounds) { expect_within_bounds(GetParam(), false); }
TEST_P(SimdContactFunction, OfAnyLengthsIsWithinBounds) { expect_within_bounds(GetParam(), true); }

INSTANTIATE_TEST_SUITE_P(Families, SimdContactFunction, testing::ValuesIn(test::pair_families()),
                         test::family_name);

class Bracket : public testing::TestWithParam<test::PairFamily> {};

// In any company; returns the latest time of all instruction sets.
double latest_bracket(const SimdPair& pair, const std::vector<PairRow>& rows, std::size_t at,
                      const test::NeedlePair& drawn) {
  double latest = 0;
  for (const Isa isa : available()) {
    const double from = bracketed(near_kernels(isa), pair.seeker, rows)[at];
    EXPECT_LE(from / pair.unit, pair.truth.elapsed.hi)
        << "pair " << at << " of " << rows.size() << ", of " << drawn.horizon << ", half lengths "
        << pair.halves().first << " and " << pair.halves().second << ", unit " << pair.unit << ", "
        << name_of(isa) << "\n"
        << test::csv_line(0, drawn);
    latest = std::max(latest, from);
  }
  return latest;
}

TEST_P(Bracket, IsNeverTooLate) {
  const test::PairFamily& family = GetParam();
  Random random(seed);
  std::size_t contacts = 0, id = 0;
  const std::size_t count = (family.thermal ? 100000 : 10000) / thin;
  for (const test::NeedlePair& drawn : draw_pairs(family.name, count, seed)) {
    const SimdPair pair = simd_pair(random, drawn);
    ++id;
    if (!pair.truth.found) continue;
    ++contacts;
    const double latest = latest_bracket(pair, {pair.row}, 0, drawn);
    ASSERT_FALSE(HasFailure());
    // The oracle is independent of the engine, and slow.
    if (id % 50 != 0) continue;
    const auto oracle =
        test::first_contact(drawn.first, drawn.second, drawn.horizon, drawn.just_collided);
    if (!oracle.contact || oracle.time > pair.truth.elapsed.hi) continue;
    ASSERT_LE(latest / pair.unit, oracle.time) << "seed " << seed << "\n"
                                               << test::csv_line(id - 1, drawn);
  }
  EXPECT_GT(contacts, count / 20);
}

// Squares of speeds and of their reciprocals that no float holds: what is no number, or none that a
// rough operation takes, rules nothing out. A search looks no farther ahead than a few units.
TEST_P(Bracket, OfAnySpeedsIsNeverTooLate) {
  const test::PairFamily& family = GetParam();
  Random random(seed + 7);
  std::size_t contacts = 0;
  const std::size_t count = (family.thermal ? 30000 : 6000) / thin;
  for (const test::NeedlePair& drawn : draw_pairs(family.name, count, seed + 7)) {
    const SimdPair pair =
        simd_pair(random, drawn, any_halves(random), std::ldexp(1.0, random.below(181) - 90));
    if (!pair.truth.found || pair.truth.elapsed.hi * pair.unit > pair.row[PairColumns::until])
      continue;
    ++contacts;
    latest_bracket(pair, {pair.row}, 0, drawn);
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(contacts, count / 200);
}

// Others of the same seeker share the lanes with the pair, and leave some of its time to wait for
// one. Of any lengths: the contact that a pair was built around often lies beyond a tip of shorter
// needles.
TEST_P(Bracket, AmongOthersIsNeverTooLate) {
  const test::PairFamily& family = GetParam();
  Random random(seed + 9);
  std::vector<PairRow> others;
  std::size_t contacts = 0;
  const std::size_t count = (family.thermal ? 50000 : 10000) / thin;
  for (const test::NeedlePair& drawn : draw_pairs(family.name, count, seed + 9)) {
    const SimdPair pair = simd_pair(random, drawn, any_halves(random));
    if (!others.empty() && pair.truth.found) {
      ++contacts;
      std::vector<PairRow> rows(1 + random.below(16));
      for (PairRow& row : rows) row = others[random.below(static_cast<int>(others.size()))];
      // One like it, or several.
      const std::size_t at = random.below(static_cast<int>(rows.size()));
      for (std::size_t n = at; n < rows.size(); n += 1 + random.below(30)) rows[n] = pair.row;
      latest_bracket(pair, rows, at, drawn);
      ASSERT_FALSE(HasFailure());
    }
    if (others.size() < 32) others.push_back(pair.row);
    others[random.below(static_cast<int>(others.size()))] = pair.row;
  }
  EXPECT_GT(contacts, count / 100);
}

INSTANTIATE_TEST_SUITE_P(Families, Bracket, testing::ValuesIn(test::pair_families()),
                         test::family_name);

// Of phases that floats do not know; not even from a time that its margin does not change.
TEST(BracketOfLargePhases, RulesNothingOut) {
  using C = PairColumns;
  Motion still{};
  still.u[2] = still.p[0] = 1;
  still.omega = 100;
  still.half = 0.5f;
  PairRow row{};
  row[C::u_x] = row[C::p_y] = 1;
  row[C::half] = 0.5f;
  for (const float from : {0.0f, 500.0f, 1024.0f}) {
    row[C::from] = from;
    row[C::until] = 1024;
    for (const Isa isa : available()) {
      for (const std::size_t count : {1, 5, 40}) {
        const std::vector<PairRow> rows(count, row);
        for (const float found : bracketed(near_kernels(isa), seeker_of(still, 1024), rows)) {
          EXPECT_LE(found, from) << name_of(isa);
        }
      }
    }
  }
}

// At least 99 % of the pairs, and times before 90 % of the contacts by less than a tenth.
void expect_few_left(Isa isa) {
  Random random(seed);
  std::size_t apart = 0, ruled_out = 0, contacts = 0, close = 0;
  for (const test::NeedlePair& drawn : draw_pairs("thermal-k6", 20000 / thin, seed + 1)) {
    // From where the spheres meet, over a short time.
    test::NeedlePair pair = advanced(drawn, 0.3 * drawn.horizon);
    pair.horizon = 0.1;
    const KernelPair kernel = kernel_pair(pair);
    EvaluationCounters work;
    const Contact truth = first_contact(kernel.view(), 0, pair.horizon, work);
    const double unit = unit_of(kernel.first, kernel.second);
    const float until = static_cast<float>(pair.horizon * unit);
    const Seeker seeker = seeker_of(motion_of(kernel.first, 0, unit), until);
    const Motion other = motion_of(kernel.second, 0, unit);
    const double from = bracketed(near_kernels(isa), seeker, {row_of(seeker, other, 0, until)})[0];
    if (truth.found) {
      ++contacts;
      close += from / unit > 0.9 * truth.elapsed.hi;
    } else {
      ++apart;
      ruled_out += std::isinf(from);
    }
  }
  EXPECT_GT(contacts, 100 / thin);
  EXPECT_GT(static_cast<double>(ruled_out), 0.99 * static_cast<double>(apart)) << name_of(isa);
  EXPECT_GT(static_cast<double>(close), 0.9 * static_cast<double>(contacts)) << name_of(isa);
}

TEST(BracketOfThermalPairs, RulesOutMostThatDoNotMeet) {
  for (const Isa isa : available()) expect_few_left(isa);
}

}  // namespace
}  // namespace needlework::kernels
