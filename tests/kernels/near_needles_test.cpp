// SIMD kernels: the same bits on every instruction set, whatever the other lanes hold; never a
// contact lost, whatever the lengths; and most pairs that do not meet ruled out.
#include "kernels/near_needles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <ostream>
#include <string>

#include "kernels/first_contact.h"
#include "tests/kernels/simd_pairs.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/oracle.h"
#include "tests/support/pair_families.h"
#include "tests/support/pairs_csv.h"
#include "tests/support/segments.h"

namespace needlework::kernels {

static void PrintTo(Isa isa, std::ostream* out) { *out << name_of(isa); }

namespace {

using test::bracketed;
using test::draw_pairs;
using test::KernelPair;
using test::motion_of;
using test::PairRow;
using test::Random;
using test::row_of;
using test::seeker_of;
using test::unit_of;
using test::vec3;

constexpr std::uint64_t seed = 909;
#ifdef NDEBUG
constexpr std::size_t thin = 1;
#else
constexpr std::size_t thin = 20;
#endif

/// Blocks of needles in cells around a seeker, whatever they hold.
struct Neighbourhood {
  std::vector<NeedleBlock> blocks;
  std::vector<BlockLink> links;
  std::vector<CellView> cells;
  Seeker seeker{};

  Surroundings around() const { return {blocks.data(), links.data(), cells.data(), cells.size()}; }
};

/// What a kernel finds around a seeker; `apply` calls it. What it leaves behind the last one does
/// not matter.
template <class Apply>
std::vector<std::pair<std::uint32_t, std::uint32_t>> found_by(const Neighbourhood& near,
                                                              Apply&& apply) {
  const std::size_t room = (near.blocks.size() + 1) * block_size;
  std::vector<std::uint32_t> needles(room), cells(room);
  const Scan scan = apply(Found{needles.data(), cells.data()});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  for (std::size_t n = 0; n < scan.found; ++n) out.push_back({needles[n], cells[n]});
  return out;
}

/// Numbers for one needle in a block.
using BlockRow = std::array<float, NeedleBlock::columns>;

/// Fills cells with needles of ids from 1 on, some of them with chains of blocks, some empty; what
/// stands beyond the last needle of a block is not a number.
Neighbourhood fill(Random& random, const Seeker& seeker, const std::vector<BlockRow>& rows) {
  Neighbourhood out;
  out.seeker = seeker;
  std::size_t next = 0;
  while (next < rows.size()) {
    const auto first = static_cast<std::uint32_t>(out.blocks.size());
    out.cells.push_back({first, {}});
    for (int chained = random.below(3); chained >= 0; --chained) {
      NeedleBlock& block = out.blocks.emplace_back();
      for (auto& column : block.column) {
        std::fill(std::begin(column), std::end(column), std::numeric_limits<float>::quiet_NaN());
      }
      std::fill(std::begin(block.needle), std::end(block.needle), 12345u);
      const auto size = chained > 0 ? block_size : random.below(block_size + 1);
      BlockLink& link = out.links.emplace_back();
      link.size = static_cast<std::uint32_t>(std::min<std::size_t>(size, rows.size() - next));
      if (chained > 0) link.next = static_cast<std::uint32_t>(out.blocks.size());
      for (std::uint32_t lane = 0; lane < link.size; ++lane, ++next) {
        for (int c = 0; c < NeedleBlock::columns; ++c) block.column[c][lane] = rows[next][c];
        block.needle[lane] = static_cast<std::uint32_t>(next + 1);
      }
    }
  }
  return out;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping(const NearKernels& kernels,
                                                                 const Neighbourhood& near,
                                                                 float radius) {
  return found_by(near, [&](const Found& found) {
    return kernels.overlapping(near.around(), near.seeker, radius, found);
  });
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> approaching(const NearKernels& kernels,
                                                                 const Neighbourhood& near) {
  return found_by(near, [&](const Found& found) {
    return kernels.approaching(near.around(), near.seeker, found);
  });
}

/// All that are not a number are one.
template <class Values>
std::vector<std::uint32_t> bits(const Values& values) {
  std::vector<std::uint32_t> out;
  for (const float value : values) {
    out.push_back(std::isnan(value) ? 0xffffffff : std::bit_cast<std::uint32_t>(value));
  }
  return out;
}

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
SimdPair simd_pair(Random& random, const test::NeedlePair& drawn, Halves halves = {}) {
  SimdPair out;
  if (drawn.just_collided) halves.second = halves.first;
  out.pair = lengthened(kernel_pair(drawn), 2 * std::max(halves.first, halves.second));
  out.pair.half_first = halves.first;
  out.pair.half_second = halves.second;
  if (drawn.just_collided) {
    const int side = side_after(out.pair.view());
    out.pair.touch = {.touching = side != 0, .collided = true, .side = side, .gap = 0};
  }
  SearchCounters work;
  const double horizon = drawn.horizon * (random.coin() ? 1 : random.uniform());
  out.truth = first_contact(out.pair.view(), 0, horizon, work);
  // The gas may be faster or slower than this pair, and the partner placed some time ago.
  out.unit = unit_of(out.pair.first, out.pair.second) * std::ldexp(1.0, random.below(5) - 2);
  const double age = random.coin() ? 0 : random.uniform(0, 4) / out.unit;
  const auto until = static_cast<float>(horizon * out.unit) + test::simd_time_margin;
  out.seeker = seeker_of(motion_of(out.pair.first, 0, out.unit, halves.first), until);
  const Motion other = motion_of(out.pair.second, -age, out.unit, halves.second);
  const double from = out.truth.found && random.below(4) == 0
                          ? random.uniform() * out.truth.elapsed.hi * out.unit
                          : 0;
  out.row = row_of(out.seeker, other, static_cast<float>(from), until);
  return out;
}

/// Equal or not, often those of needles of length 1.
Halves any_halves(Random& random) {
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

std::vector<std::string_view> family_names() {
  std::vector<std::string_view> out;
  for (const test::PairFamily& family : test::pair_families()) out.push_back(family.name);
  return out;
}

std::string family_id(const test::PairFamily& family) {
  std::string name(family.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// ---- the same bits ----

class OnEveryIsa : public testing::TestWithParam<Isa> {
 protected:
  void SetUp() override {
    const std::vector<Isa> offered = available();
    if (std::find(offered.begin(), offered.end(), GetParam()) == offered.end()) {
      GTEST_SKIP() << "this processor lacks " << name_of(GetParam());
    }
  }
  const NearKernels& kernels() const { return near_kernels(GetParam()); }
  const NearKernels& twin() const { return near_kernels(Isa::scalar); }

  /// The same as the twin, and in any order.
  void expect_same(Random& random, const Seeker& seeker, const std::vector<PairRow>& rows) {
    const std::vector<float> truth = bracketed(twin(), seeker, rows);
    EXPECT_EQ(bits(bracketed(kernels(), seeker, rows)), bits(truth)) << "seed " << seed;
    const auto s = static_cast<float>(random.uniform());
    const auto values = test::contact_functions(kernels(), seeker, rows, s);
    const auto expected_values = test::contact_functions(twin(), seeker, rows, s);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      EXPECT_EQ(bits(values[n]), bits(expected_values[n])) << "pair " << n << ", seed " << seed;
    }
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
    EXPECT_EQ(bits(bracketed(kernels(), seeker, shuffled)), bits(expected)) << "seed " << seed;
  }
};

TEST_P(OnEveryIsa, HasItsOwnKernels) {
  EXPECT_EQ(kernels().isa, GetParam());
  const std::size_t lanes[] = {1, 4, 8, 16};
  EXPECT_EQ(kernels().lanes, lanes[static_cast<int>(GetParam())]);
}

// Partners from every family for one seeker: what they were built around is lost but for the first,
// directors and speeds of all kinds stay.
TEST_P(OnEveryIsa, BracketsToTheSameBits) {
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
      expect_same(random, seeker, rows);
      for (const float from : bracketed(twin(), seeker, rows)) ruled_out += std::isinf(from);
      pairs += count;
    }
    ASSERT_FALSE(HasFailure()) << count << " pairs";
  }
  EXPECT_GT(ruled_out, pairs / 10);
  EXPECT_LT(ruled_out, pairs * 9 / 10);
}

TEST_P(OnEveryIsa, BracketsAnyNumbersToTheSameBits) {
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
    expect_same(random, seeker, rows);
    for (const float from : bracketed(twin(), seeker, rows)) ASSERT_GE(from, 0);
    ASSERT_FALSE(HasFailure()) << n;
  }
}

TEST_P(OnEveryIsa, FindsTheSameNeighbours) {
  Random random(seed);
  std::size_t overlaps = 0, approaches = 0, needles = 0;
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
    for (BlockRow& row : rows) {
      for (float& value : row) value = draw();
    }
    seeker.longest_half = wild ? draw() : 0.5f;
    Neighbourhood near = fill(random, seeker, rows);
    if (!rows.empty()) {
      near.seeker.needle =
          static_cast<std::uint32_t>(1 + random.below(static_cast<int>(rows.size())));
    }
    for (CellView& cell : near.cells) {
      for (float& offset : cell.offset) offset = draw();
    }
    const float radius = static_cast<float>(random.uniform());
    const auto truth = overlapping(twin(), near, radius);
    EXPECT_EQ(overlapping(kernels(), near, radius), truth) << "seed " << seed;
    EXPECT_EQ(approaching(kernels(), near), approaching(twin(), near)) << "seed " << seed;
    for (const auto& [needle, cell] : truth) {
      ASSERT_TRUE(needle >= 1 && needle <= rows.size() && needle != near.seeker.needle);
    }
    overlaps += truth.size();
    approaches += approaching(twin(), near).size();
    needles += rows.size();
    ASSERT_FALSE(HasFailure()) << n;
  }
  EXPECT_GT(overlaps, needles / 20);
  EXPECT_LT(overlaps, needles / 2);
  EXPECT_GT(approaches, needles / 20);
  EXPECT_LT(approaches, needles * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Isas, OnEveryIsa,
                         testing::Values(Isa::scalar, Isa::sse4, Isa::avx2, Isa::avx512),
                         [](const auto& info) { return std::string(name_of(info.param)); });

// ---- the contact function, within its bounds ----

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

// ---- no contact lost ----

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
    // The oracle knows nothing of the engine, and takes its time.
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

// ---- most of the rest ruled out ----

// 99.9 % of the pairs, and times before 98 % of the contacts by less than a tenth.
TEST(BracketOfThermalPairs, RulesOutMostThatDoNotMeet) {
  Random random(seed);
  std::size_t apart = 0, ruled_out = 0, contacts = 0, close = 0;
  for (const test::NeedlePair& drawn : draw_pairs("thermal-k6", 20000 / thin, seed + 1)) {
    // From where the spheres meet, over a short window.
    test::NeedlePair pair = advanced(drawn, 0.3 * drawn.horizon);
    pair.horizon = 0.1;
    const KernelPair kernel = kernel_pair(pair);
    SearchCounters work;
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

// ---- bounding volumes and spheres ----

// Capsules that just overlap, just do not, and any.
TEST(Overlapping, LosesNoCapsulesThatOverlapAndFindsFewOthers) {
  Random random(seed);
  std::size_t overlaps = 0, apart = 0;
  for (std::size_t n = 0; n < 2000 / thin; ++n) {
    const double radius = random.log_uniform(1e-3, 10);
    const Vec3d corner{4, 4, 4}, r = vec3(random.direction()) * random.uniform(0, 1.7);
    const Vec3d u = vec3(random.direction());
    const Halves halves = any_halves(random);
    const double h1 = halves.first, h2 = halves.second;
    Motion motion{};
    motion.half = static_cast<float>(h1);
    Seeker seeker = seeker_of(motion, 1, h2);
    const auto store = [](auto* to, const Vec3d& a) {
      to[0] = static_cast<float>(a.x);
      to[1] = static_cast<float>(a.y);
      to[2] = static_cast<float>(a.z);
    };
    store(seeker.r, corner + r);
    store(seeker.u, u);
    std::vector<BlockRow> rows(40);
    std::vector<double> distance;
    for (BlockRow& row : rows) {
      Vec3d a = vec3(random.direction());
      const int kind = random.below(4);
      if (kind == 0) a = normalised(u + a * random.log_uniform(1e-9, 1e-2));
      Vec3d other = r + vec3(random.direction()) * random.uniform(0, 2 * radius + 1);
      if (kind < 3) {
        // Moved along their closest approach to overlap by very little, or not quite.
        const auto nearest = test::nearest_points(r, u, other, a, h1, h2);
        const double length = std::sqrt(dot(nearest.gap, nearest.gap));
        if (length > 1e-3) {
          const double wanted =
              2 * radius + (random.coin() ? 1 : -1) * random.log_uniform(1e-8, 1e-3);
          other = other + nearest.gap * ((length - wanted) / length);
        }
      }
      const Vec3d gap = test::nearest_points(r, u, other, a, h1, h2).gap;
      distance.push_back(std::sqrt(dot(gap, gap)));
      store(row.data() + NeedleBlock::x, corner + other);
      store(row.data() + NeedleBlock::a_x, a);
    }
    const Neighbourhood near = fill(random, seeker, rows);
    std::vector<bool> found(rows.size());
    for (const auto& [needle, cell] :
         overlapping(near_kernels(Isa::scalar), near, static_cast<float>(radius))) {
      found[needle - 1] = true;
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double off = distance[k] - 2 * radius;
      if (off <= 0) {
        ++overlaps;
        ASSERT_TRUE(found[k]) << "overlap by " << -off << ", radius " << radius << ", seed "
                              << seed;
      } else if (off > 1e-4 * (1 + radius)) {
        ++apart;
        ASSERT_FALSE(found[k]) << "apart by " << off << ", radius " << radius << ", seed " << seed;
      }
    }
  }
  EXPECT_GT(overlaps, 20000 / thin);
  EXPECT_GT(apart, 5000 / thin);
}

// Whether |r + v s| <= reach for some s in [0, until], in many digits.
bool spheres_meet(const Vec3d& r, const Vec3d& v, double reach, double until) {
  const auto product = [](const Vec3d& a, const Vec3d& b) {
    return test::Quad(test::Quad(a.x) * b.x + test::Quad(a.y) * b.y + test::Quad(a.z) * b.z);
  };
  const test::Quad vv = product(v, v), rv = product(r, v);
  test::Quad s = vv > 0 ? test::Quad(-rv / vv) : test::Quad(0);
  s = std::min(std::max(s, test::Quad(0)), test::Quad(until));
  return product(r, r) + 2 * rv * s + vv * s * s <= test::Quad(reach) * reach;
}

// Centres in a cell of side 8, at times up to the longest, speeds around the unit and far from it.
TEST(Approaching, LosesNoSpheresThatMeetAndFindsFewOthers) {
  Random random(seed);
  std::size_t meetings = 0, found_apart = 0, apart = 0;
  for (std::size_t n = 0; n < 2000 / thin; ++n) {
    const double now = random.uniform(0, longest_time), ahead = random.log_uniform(1e-3, 4);
    const auto speed = [&] {
      const int kind = random.below(8);
      return kind == 0 ? 0.0 : kind == 1 ? random.log_uniform(1e-6, 1e3) : 1.0;
    };
    const Halves halves = any_halves(random);
    const double reach = halves.first + halves.second;
    Flight mine;
    mine.r = vec3(random.direction()) * random.uniform(0, 3);
    mine.v = vec3(random.normal_vector(speed()));
    Seeker seeker = seeker_of(motion_of(mine, 0, 1, halves.first),
                              static_cast<float>(ahead) + test::simd_time_margin, halves.second);
    seeker.motion.time = seeker.now = static_cast<float>(now);
    std::vector<BlockRow> rows(40);
    std::vector<Flight> others(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
      Flight& other = others[k];
      const double age = random.below(3) == 0 ? 0 : random.uniform(0, now);
      other.v = vec3(random.normal_vector(speed()));
      other.r = vec3(random.direction()) * random.uniform(0, 4);
      if (random.coin()) {
        // Passing at a distance next to the reach.
        const Vec3d w = other.v - mine.v;
        const Vec3d across = normalised(cross(vec3(random.direction()), w + Vec3d{1e-30, 0, 0}));
        const double passing = reach + (random.coin() ? 1 : -1) * random.log_uniform(1e-9, 1e-2);
        other.r = mine.r + across * passing - w * random.uniform(0, 1.2 * ahead);
      }
      const Vec3d then = other.r - other.v * age - Vec3d{-4, -4, -4};
      const Vec3d v = other.v;
      const double values[] = {then.x, then.y, then.z, v.x, v.y, v.z, now - age};
      for (int c = 0; c < NeedleBlock::columns; ++c) rows[k][c] = static_cast<float>(values[c]);
    }
    const Neighbourhood near = fill(random, seeker, rows);
    std::vector<bool> found(rows.size());
    for (const auto& [needle, cell] : approaching(near_kernels(Isa::scalar), near)) {
      found[needle - 1] = true;
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
      // Within a cell while it flew there; beyond, its block would have been written again.
      const Vec3d then{rows[k][0], rows[k][1], rows[k][2]};
      if (dot(then, then) > 400) continue;
      const Vec3d r = mine.r - others[k].r, v = mine.v - others[k].v;
      if (spheres_meet(r, v, reach, ahead)) {
        ++meetings;
        ASSERT_TRUE(found[k]) << "seed " << seed << ", case " << n;
      } else if (!spheres_meet(r, v, reach + 0.01, ahead)) {
        ++apart;
        found_apart += found[k];
      }
    }
  }
  EXPECT_GT(meetings, 10000 / thin);
  EXPECT_GT(apart, 10000 / thin);
  EXPECT_LT(found_apart, apart / 50);
}

}  // namespace
}  // namespace needlework::kernels
