// Pairs drawn from a family, as the SIMD kernels see them, with the contact that is true.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/first_contact.h"
#include "kernels/near_needles.h"
#include "tests/kernels/simd_pairs.h"
#include "tests/support/by_build.h"
#include "tests/support/collided_pair.h"
#include "tests/support/family_name.h"
#include "tests/support/random.h"

namespace needlework::kernels {

using test::draw_pairs;
using test::KernelPair;
using test::motion_of;
using test::PairRow;
using test::Random;
using test::row_of;
using test::seeker_of;
using test::unit_of;

/// Of the random numbers of the tests.
inline constexpr std::uint64_t seed = 909;
/// Builds without optimisation draw so many times fewer pairs.
inline constexpr std::size_t thin = test::by_build<std::size_t>(1, 20);

/// Half lengths of two needles, in units of length.
struct Halves {
  double first = 0.5, second = 0.5;
};

/// One pair of a family, the first needle seeking.
struct SimdPair {
  KernelPair pair;
  Contact truth;
  double unit;
  Seeker seeker;
  PairRow row;

  Halves halves() const { return {pair.half_first, pair.half_second}; }
};

/// The pair as large as its longer needle, so that only the other one is shorter than drawn. Pairs
/// that have just collided, within both needles, keep equal lengths.
/// Of a gas `swift` times faster, one search looks some units of its time ahead at most.
inline SimdPair simd_pair(Random& random, const test::NeedlePair& drawn, Halves halves = {},
                          double swift = 1) {
  SimdPair out;
  if (drawn.just_collided) halves.second = halves.first;
  out.pair = lengthened(kernel_pair(drawn), 2 * std::max(halves.first, halves.second));
  out.pair.half_first = halves.first;
  out.pair.half_second = halves.second;
  if (drawn.just_collided) test::take_side_of_collision(out.pair);
  EvaluationCounters work;
  const double horizon = drawn.horizon * (random.coin() ? 1 : random.uniform());
  out.truth = first_contact(out.pair.view(), 0, horizon, work);
  // The gas may be faster or slower than this pair, and the partner placed some time ago.
  out.unit = unit_of(out.pair.first, out.pair.second) * std::ldexp(swift, random.below(5) - 2);
  const double age = random.coin() ? 0 : random.uniform(0, 4) / out.unit;
  auto until = static_cast<float>(horizon * out.unit) + test::simd_time_margin;
  if (swift != 1) until = std::min(until, longest_time);
  out.seeker = seeker_of(motion_of(out.pair.first, 0, out.unit, halves.first), until);
  const Motion other = motion_of(out.pair.second, -age, out.unit, halves.second);
  const double from = out.truth.found && random.below(4) == 0
                          ? random.uniform() * out.truth.elapsed.hi * out.unit
                          : 0;
  out.row = row_of(out.seeker, other, static_cast<float>(from), until);
  return out;
}

/// Equal or not, often those of needles of length 1.
inline Halves any_halves(Random& random) {
  switch (random.below(4)) {
    case 0:
      return {0.5, random.uniform(0.02, 0.5)};
    case 1:
      return {random.uniform(0.02, 0.5), 0.5};
    case 2: {
      const double half = random.uniform(0.25, 0.5);
      return {half, half};
    }
    default:
      return {};
  }
}

inline std::vector<std::string_view> family_names() {
  std::vector<std::string_view> out;
  for (const test::PairFamily& family : test::pair_families()) out.push_back(family.name);
  return out;
}

}  // namespace needlework::kernels
