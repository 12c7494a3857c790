// Intervals of time in the lanes of a vector, on every instruction set: none is lost or changed
// when they are moved, and parts of one cover it.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "tests/kernels/drawn_simd_pairs.h"
#include "tests/kernels/exposed_kernels.h"

namespace needlework::kernels {
namespace {

using Interval = std::tuple<std::uint32_t, float, float>;  // of a pair, from and to

std::vector<Interval> taken(const ExposedIntervals& all, std::size_t lanes) {
  std::vector<Interval> out;
  for (std::size_t n = 0; n < lanes; ++n) {
    if (all.taken[n] > 0) out.emplace_back(all.pair[n], all.low[n], all.high[n]);
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// In lanes where bits are set; anything in others.
ExposedIntervals any_intervals(Random& random, unsigned bits) {
  ExposedIntervals out;
  for (int n = 0; n < 16; ++n) {
    out.taken[n] = bits >> n & 1 ? 1.0f : 0.0f;
    out.low[n] = static_cast<float>(random.uniform());
    out.high[n] = out.low[n] + static_cast<float>(random.log_uniform(1e-6, 10));
    out.pair[n] = static_cast<std::uint32_t>(random.below(16));
  }
  return out;
}

unsigned any_bits(Random& random, std::size_t lanes) {
  return static_cast<unsigned>(random.bits() & random.bits()) & ((1u << lanes) - 1);
}

TEST(Intervals, AreAddedToThoseThatAreThere) {
  Random random(seed);
  std::size_t added = 0;
  for (const Isa isa : available()) {
    const std::size_t lanes = near_kernels(isa).lanes;
    for (int n = 0; n < 3000; ++n) {
      const ExposedIntervals all = any_intervals(random, any_bits(random, lanes));
      ExposedIntervals more = any_intervals(random, any_bits(random, lanes));
      // No more than there is room for.
      std::size_t room = lanes - taken(all, lanes).size();
      for (float& each : more.taken) each = each > 0 && room > 0 ? (--room, 1.0f) : 0.0f;
      std::vector<Interval> expected = taken(all, lanes);
      const std::vector<Interval> others = taken(more, lanes);
      expected.insert(expected.end(), others.begin(), others.end());
      std::sort(expected.begin(), expected.end());
      ASSERT_EQ(taken(exposed_add(isa, all, more), lanes), expected) << name_of(isa);
      added += others.size();
    }
  }
  EXPECT_GT(added, 2000u);
}

TEST(Intervals, AreSpreadInPartsThatCoverThem) {
  Random random(seed + 1);
  for (const Isa isa : available()) {
    const std::size_t lanes = near_kernels(isa).lanes;
    for (int n = 0; n < 3000; ++n) {
      ExposedIntervals all = any_intervals(random, any_bits(random, lanes));
      for (std::uint32_t lane = 0; lane < 16; ++lane) all.pair[lane] = 15 - lane;
      const std::vector<Interval> whole = taken(all, lanes);
      if (whole.empty()) continue;
      const std::vector<Interval> parts = taken(exposed_spread(isa, all), lanes);
      const std::size_t each = lanes / whole.size();
      ASSERT_EQ(parts.size(), each * whole.size()) << name_of(isa);
      for (std::size_t k = 0; k < whole.size(); ++k) {
        const auto& [pair, low, high] = whole[k];
        float from = low;
        for (std::size_t part = k * each; part < (k + 1) * each; ++part) {
          const auto& [of, begin, end] = parts[part];
          ASSERT_EQ(of, pair) << name_of(isa);
          ASSERT_EQ(begin, from) << name_of(isa);
          ASSERT_LE(begin, end) << name_of(isa);
          from = end;
        }
        ASSERT_EQ(from, high) << name_of(isa);
      }
    }
  }
}

}  // namespace
}  // namespace needlework::kernels
