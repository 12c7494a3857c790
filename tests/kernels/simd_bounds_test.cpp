// What the SIMD kernels say of a pair: values within their bounds, never a contact lost, whatever
// the lengths, and most pairs that do not meet ruled out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

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
  double worst[5] = {};
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
    const auto got =
        test::contact_functions(near_kernels(Isa::scalar), pair.seeker, {pair.row}, s)[0];
    // The third derivative as a quotient of differences, off by 1e-18 of its bound.
    const DoubleDouble step(1e-9 / (frame.v_norm + frame.w_sum));
    const DoubleDouble third =
        (evaluate(frame, at + step).ddf - evaluate(frame, at - step).ddf) / (step + step);
    const double expected[] = {to_double(exact.f), to_double(exact.df), to_double(exact.ddf),
                               to_double(third)};
    for (int n = 0; n < 4; ++n) {
      const double error = std::abs(got[C::f + n] - expected[n]), bound = got[C::error_f + n];
      ASSERT_LE(error, bound / 4) << "derivative " << n << " at " << s << ", seed " << seed << "\n"
                                  << test::csv_line(0, drawn);
      if (error > 0) worst[n] = std::max(worst[n], error / bound);
    }
    const Vec3d gap = test::nearest_points(r, to_double(exact.u[0]), Vec3d{}, to_double(exact.u[1]),
                                           halves.first, halves.second)
                          .gap;
    const double error = std::abs(got[C::gap] - std::sqrt(dot(gap, gap)));
    ASSERT_LE(error, got[C::error_f] / 4) << "gap at " << s << ", seed " << seed << "\n"
                                          << test::csv_line(0, drawn);
    worst[4] = std::max(worst[4], error / got[C::error_f]);
  }
  std::printf("of %zu: errors up to %.2f, %.2f, %.2f, %.2f, that of the gap %.2f of their bounds\n",
              near, worst[0], worst[1], worst[2], worst[3], worst[4]);
  EXPECT_GT(near, count / 20);
}

TEST_P(SimdContactFunction, IsWithinBounds) { expect_within_bounds(GetParam(), false); }
TEST_P(SimdContactFunction, OfAnyLengthsIsWithinBounds) { expect_within_bounds(GetParam(), true); }

INSTANTIATE_TEST_SUITE_P(Families, SimdContactFunction, testing::ValuesIn(test::pair_families()),
                         [](const auto& info) { return family_id(info.param); });

class Bracket : public testing::TestWithParam<test::PairFamily> {};

TEST_P(Bracket, IsNeverTooLate) {
  const test::PairFamily& family = GetParam();
  const NearKernels& kernels = near_kernels(Isa::scalar);
  Random random(seed);
  std::size_t contacts = 0, id = 0;
  const std::size_t count = (family.thermal ? 100000 : 10000) / thin;
  for (const test::NeedlePair& drawn : draw_pairs(family.name, count, seed)) {
    const SimdPair pair = simd_pair(random, drawn);
    const double from = bracketed(kernels, pair.seeker, {pair.row})[0];
    ++id;
    if (!pair.truth.found) continue;
    ++contacts;
    ASSERT_LE(from / pair.unit, pair.truth.elapsed.hi)
        << "of " << drawn.horizon << ", seed " << seed << "\n"
        << test::csv_line(id - 1, drawn);
    // The oracle is independent of the engine, and slow.
    if (id % 50 != 0) continue;
    const auto oracle =
        test::first_contact(drawn.first, drawn.second, drawn.horizon, drawn.just_collided);
    if (!oracle.contact || oracle.time > pair.truth.elapsed.hi) continue;
    ASSERT_LE(from / pair.unit, oracle.time) << "seed " << seed << "\n"
                                             << test::csv_line(id - 1, drawn);
  }
  EXPECT_GT(contacts, count / 20);
}

// The contact that the pair was built around often lies beyond a tip of shorter needles.
TEST_P(Bracket, OfAnyLengthsIsNeverTooLate) {
  const test::PairFamily& family = GetParam();
  const NearKernels& kernels = near_kernels(Isa::scalar);
  Random random(seed + 3);
  std::size_t contacts = 0;
  const std::size_t count = (family.thermal ? 50000 : 10000) / thin;
  for (const test::NeedlePair& drawn : draw_pairs(family.name, count, seed + 3)) {
    const SimdPair pair = simd_pair(random, drawn, any_halves(random));
    const Halves halves = pair.halves();
    if (!pair.truth.found) continue;
    ++contacts;
    const double from = bracketed(kernels, pair.seeker, {pair.row})[0];
    ASSERT_LE(from / pair.unit, pair.truth.elapsed.hi)
        << "of " << drawn.horizon << ", half lengths " << halves.first << " and " << halves.second
        << ", seed " << seed << "\n"
        << test::csv_line(contacts, drawn);
  }
  EXPECT_GT(contacts, count / 100);
}

INSTANTIATE_TEST_SUITE_P(Families, Bracket, testing::ValuesIn(test::pair_families()),
                         [](const auto& info) { return family_id(info.param); });

// At least 99 % of the pairs, and times before 90 % of the contacts by less than a tenth.
TEST(BracketOfThermalPairs, RulesOutMostThatDoNotMeet) {
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
    const double from =
        bracketed(near_kernels(Isa::scalar), seeker, {row_of(seeker, other, 0, until)})[0];
    if (truth.found) {
      ++contacts;
      close += from / unit > 0.9 * truth.elapsed.hi;
    } else {
      ++apart;
      ruled_out += std::isinf(from);
    }
  }
  EXPECT_GT(contacts, 100 / thin);
  EXPECT_GT(static_cast<double>(ruled_out), 0.99 * static_cast<double>(apart));
  EXPECT_GT(static_cast<double>(close), 0.9 * static_cast<double>(contacts));
}

}  // namespace
}  // namespace needlework::kernels
