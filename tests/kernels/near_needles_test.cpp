// What a SIMD kernel says of a pair or a needle depends on that alone, not on its place among
// others or on what unused lanes hold. Of any numbers it says something.
#include "kernels/near_needles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <ostream>
#include <string>

#include "tests/kernels/drawn_simd_pairs.h"
#include "tests/kernels/neighbourhoods.h"

namespace needlework::kernels {

static void PrintTo(Isa isa, std::ostream* out) { *out << name_of(isa); }

namespace {

using test::bracketed;
using test::vec3;

/// All that are not a number are one.
template <class Values>
std::vector<std::uint32_t> bits(const Values& values) {
  std::vector<std::uint32_t> out;
  out.reserve(values.size());
  for (const float value : values) {
    out.push_back(std::isnan(value) ? 0xffffffff : std::bit_cast<std::uint32_t>(value));
  }
  return out;
}

class OnEveryIsa : public testing::TestWithParam<Isa> {
 protected:
  void SetUp() override {
    const std::vector<Isa> offered = available();
    if (std::find(offered.begin(), offered.end(), GetParam()) == offered.end()) {
      GTEST_SKIP() << "this processor lacks " << name_of(GetParam());
    }
  }
  const NearKernels& kernels() const { return near_kernels(GetParam()); }

  /// The same in any order, and next to any numbers; returns the times.
  std::vector<float> expect_same(Random& random, const Seeker& seeker,
                                 const std::vector<PairRow>& rows) {
    const std::vector<float> truth = bracketed(kernels(), seeker, rows);
    const auto s = static_cast<float>(random.uniform());
    const auto values = test::contact_functions(kernels(), seeker, rows, s);
    std::vector<std::size_t> order(rows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t n = order.size(); n > 1; --n) {
      std::swap(order[n - 1], order[random.below(static_cast<int>(n))]);
    }
    std::vector<PairRow> shuffled;
    std::vector<float> expected;
    for (const std::size_t n : order) {
      shuffled.push_back(rows[n]);
      expected.push_back(truth[n]);
    }
    const float beyond = test::any_float(random);
    EXPECT_EQ(bits(bracketed(kernels(), seeker, shuffled, beyond)), bits(expected))
        << "seed " << seed;
    const auto shuffled_values = test::contact_functions(kernels(), seeker, shuffled, s, beyond);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      EXPECT_EQ(bits(shuffled_values[n]), bits(values[order[n]]))
          << "pair " << n << ", seed " << seed;
    }
    return truth;
  }

  using FoundNeedles = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  /// What each filter finds, in the order of ids.
  std::array<FoundNeedles, 4> found_in(const Neighbourhood& near, float radius) const {
    std::array<FoundNeedles, 4> out{
        overlapping(kernels(), near, radius), approaching(kernels(), near),
        near_capsules(kernels(), near, radius), near_paths(kernels(), near, radius)};
    for (FoundNeedles& found : out) std::sort(found.begin(), found.end());
    return out;
  }
};

TEST_P(OnEveryIsa, HasItsOwnKernels) {
  EXPECT_EQ(kernels().isa, GetParam());
  const std::size_t lanes[] = {1, 4, 8, 16};
  EXPECT_EQ(kernels().lanes, lanes[static_cast<int>(GetParam())]);
}

// Partners from every family for one seeker: what they were built around is lost but for the first,
// directors and speeds of all kinds stay.
TEST_P(OnEveryIsa, BracketsToTheSameBitsInAnyPlace) {
  Random random(seed);
  std::size_t ruled_out = 0, pairs = 0;
  for (const std::size_t count : {1, 2, 7, 8, 9, 15, 16, 17, 33, 100}) {
    for (std::size_t n = 0; n < 200 / thin; ++n) {
      std::vector<PairRow> rows;
      Seeker seeker{};
      for (const std::string_view family : family_names()) {
        for (const test::NeedlePair& drawn : draw_pairs(family, 1 + count / 11, random.bits())) {
          const SimdPair pair = simd_pair(random, drawn, any_halves(random));
          if (rows.empty()) seeker = pair.seeker;
          rows.push_back(pair.row);
        }
      }
      rows.resize(count, rows.front());
      for (const float from : expect_same(random, seeker, rows)) ruled_out += std::isinf(from);
      pairs += count;
    }
    ASSERT_FALSE(HasFailure()) << count << " pairs";
  }
  EXPECT_GT(ruled_out, pairs / 10);
  EXPECT_LT(ruled_out, pairs * 9 / 10);
}

TEST_P(OnEveryIsa, BracketsAnyNumbersToTheSameBitsInAnyPlace) {
  Random random(seed);
  for (std::size_t n = 0; n < 3000 / thin; ++n) {
    // From all sane but for one column to all wild.
    const int wild = random.below(4);
    const auto draw = [&](int column) {
      const bool any = wild == 3 || (wild > 0 && random.below(8) == 0);
      if (any) return test::any_float(random);
      const double a = column >= PairColumns::omega ? std::abs(random.normal()) : random.normal();
      return static_cast<float>(a);
    };
    Seeker seeker = seeker_of({}, 1);
    seeker.motion.half = draw(PairColumns::half);
    for (int axis = 0; axis < 3; ++axis) {
      seeker.motion.v[axis] = draw(axis);
      seeker.motion.u[axis] = draw(axis);
      seeker.motion.p[axis] = draw(axis);
    }
    seeker.motion.omega = draw(PairColumns::omega);
    std::vector<PairRow> rows(1 + random.below(40));
    for (PairRow& row : rows) {
      for (int c = 0; c < PairColumns::columns; ++c) row[c] = draw(c);
    }
    for (const float from : expect_same(random, seeker, rows)) ASSERT_GE(from, 0);
    ASSERT_FALSE(HasFailure()) << n;
  }
}

/// The same needles in the same cells, in other lanes and blocks of these, and with other numbers
/// in lanes without a needle.
Neighbourhood rearranged(Random& random, const Neighbourhood& near) {
  struct Lane {
    NeedleBlock* block;
    std::size_t lane;
  };
  Neighbourhood out = near;
  for (const CellView& cell : out.cells) {
    std::vector<Lane> taken;
    for (std::uint32_t b = cell.block; b != NeedleBlock::none;) {
      NeedleBlock& block = out.blocks[b];
      for (std::size_t lane = 0; lane < block_size; ++lane) {
        if (block.needle[lane] != NeedleBlock::none) {
          taken.push_back({&block, lane});
          continue;
        }
        for (auto& words : block.word) words[lane] = static_cast<std::uint32_t>(random.bits());
        block.time[lane] = test::any_float(random);
      }
      b = block.is_full() ? out.next[b] : NeedleBlock::none;
    }
    for (std::size_t n = taken.size(); n > 1; --n) {
      const Lane a = taken[n - 1], b = taken[random.below(static_cast<int>(n))];
      for (auto& words : a.block->word) {
        std::swap(words[a.lane], b.block->word[&words - a.block->word][b.lane]);
      }
      std::swap(a.block->needle[a.lane], b.block->needle[b.lane]);
      std::swap(a.block->time[a.lane], b.block->time[b.lane]);
    }
  }
  return out;
}

TEST_P(OnEveryIsa, FindsTheSameNeighboursInAnyPlace) {
  Random random(seed);
  std::size_t overlaps = 0, approaches = 0, beside = 0, passing = 0, needles = 0;
  for (std::size_t n = 0; n < 2000 / thin; ++n) {
    const bool wild = random.below(4) == 0;
    const auto draw = [&] {
      return wild && random.below(6) == 0 ? test::any_float(random)
                                          : static_cast<float>(random.normal());
    };
    Seeker seeker = seeker_of({}, 1);
    seeker.motion.half = random.coin() ? 0.5f : static_cast<float>(random.uniform());
    const Vec3d u = vec3(random.direction());
    seeker.u[0] = static_cast<float>(u.x);
    seeker.u[1] = static_cast<float>(u.y);
    seeker.u[2] = static_cast<float>(u.z);
    for (int axis = 0; axis < 3; ++axis) {
      seeker.r[axis] = seeker.motion.r[axis] = draw();
      seeker.motion.v[axis] = draw();
    }
    std::vector<BlockRow> rows(random.below(200));
    const WordFormat format = WordFormat::holding(-4, 4);
    const bool directors = random.coin();
    for (BlockRow& row : rows) {
      const auto coordinate = [&] { return std::clamp(random.normal(), -4.0, 4.0); };
      const auto r = vec3({coordinate(), coordinate(), coordinate()});
      row = directors ? BlockRow{r, vec3(random.direction()), true}
                      : BlockRow{r, vec3(random.normal_vector(1)), false, draw()};
    }
    seeker.longest_half = wild ? draw() : 0.5f;
    Neighbourhood near = fill(random, seeker, format, 0, rows);
    for (NeedleBlock& block : near.blocks) {
      for (auto& words : block.word) {
        for (std::uint32_t& word : words) {
          if (wild && random.below(6) == 0) word = static_cast<std::uint32_t>(random.bits());
        }
      }
    }
    if (!rows.empty()) {
      near.seeker.needle =
          static_cast<std::uint32_t>(1 + random.below(static_cast<int>(rows.size())));
    }
    for (CellView& cell : near.cells) {
      for (float& offset : cell.offset) offset = draw();
    }
    const float radius = static_cast<float>(random.uniform());
    near.seeker.axis_half = static_cast<float>(random.uniform());
    const auto found = found_in(near, radius);
    EXPECT_EQ(found_in(rearranged(random, near), radius), found) << "seed " << seed;
    for (const FoundNeedles& by_filter : found) {
      for (const auto& [needle, cell] : by_filter) {
        ASSERT_TRUE(needle >= 1 && needle <= rows.size() && needle != near.seeker.needle);
      }
    }
    overlaps += found[0].size();
    approaches += found[1].size();
    beside += found[2].size();
    passing += found[3].size();
    needles += rows.size();
    ASSERT_FALSE(HasFailure()) << n;
  }
  EXPECT_GT(overlaps, needles / 20);
  EXPECT_LT(overlaps, needles / 2);
  EXPECT_GT(beside, needles / 40);
  EXPECT_LT(beside, needles / 2);
  EXPECT_GT(passing, needles / 40);
  EXPECT_LT(passing, needles / 2);
  EXPECT_GT(approaches, needles / 20);
  EXPECT_LT(approaches, needles * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Isas, OnEveryIsa,
                         testing::Values(Isa::scalar, Isa::sse4, Isa::avx2, Isa::avx512),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace needlework::kernels
