// Every search against first_contact of all needles and all their images, while the needles move,
// cross cells, collide and are renewed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "src/search/linked_lists.h"
#include "tests/search/gas_drive.h"
#include "tests/support/by_build.h"
#include "tests/support/kernel_pair.h"

namespace needlework {
namespace {

using test::GasDrive;
using test::put;
using test::Random;
using test::SearchChoice;
using test::Speeds;
using test::vec3;

constexpr std::uint64_t seed = 1515;
constexpr int thin = test::by_build(1, 10);

Needle any_needle(Random& random, const Gas& gas) {
  return Needle(random.below(static_cast<int>(gas.size())));
}

/// One gas and how it is watched. Times are in flights of one length at its fastest speed.
struct Setting {
  const char* name;
  std::size_t count;
  std::array<double, 3> box;
  Speeds speeds;
  double span;  ///< how far ahead contacts are looked for
  double step;  ///< between checks, on average
  int checks;
  double collisions;  ///< probability of one at each check
  long least_contacts;
  std::vector<double> lengths = {1};  ///< of needles, in turn
};

void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.name; }

class Contacts : public testing::TestWithParam<Setting> {};

TEST_P(Contacts, AreProposedByEverySearch) {
  const Setting& s = GetParam();
  SCOPED_TRACE("seed " + std::to_string(seed));
  const double unit = 1 / (s.speeds.sigma * s.speeds.fast);
  Random random(seed);
  Gas gas = test::random_gas(random, s.count, s.box, s.speeds, s.lengths);
  GasDrive drive(gas, random, test::search_choices(), s.span * unit);
  const int checks = std::max(3, s.checks / thin);
  for (int n = 0; n < checks; ++n) {
    SCOPED_TRACE("check " + std::to_string(n));
    const Needle i = any_needle(random, gas);
    if (random.uniform() < s.collisions) drive.strike(i, draw_velocities(random, s.speeds));
    ASSERT_NO_FATAL_FAILURE(drive.check(i));
    ASSERT_NO_FATAL_FAILURE(drive.check_near(any_needle(random, gas)));
    ASSERT_NO_FATAL_FAILURE(drive.check_before_contact(any_needle(random, gas)));
    if (s.collisions > 0) {
      ASSERT_NO_FATAL_FAILURE(drive.bounce(any_needle(random, gas), random.uniform()));
    }
    if (n % 10 == 9) drive.shuffle();
    ASSERT_NO_FATAL_FAILURE(drive.advance(2 * random.uniform() * s.step * unit));
  }
  EXPECT_GE(drive.contacts(), s.least_contacts * checks / s.checks);
  if (s.collisions > 0 && s.count > 1) {
    EXPECT_GT(drive.bounces(), checks / 20);
  }
}

constexpr Speeds thermal;
constexpr Speeds from_rest_to_racing{.fast = 1e6, .slow = 1e-6};
constexpr Speeds with_some_fast{.fast = 100};

INSTANTIATE_TEST_SUITE_P(
    Settings, Contacts,
    testing::Values(
        Setting{"one_needle", 1, {3, 3, 3}, thermal, 2, 0.1, 50, 0.3, 0},
        Setting{"two_needles", 2, {2.01, 2.01, 2.01}, thermal, 2, 0.1, 1000, 0.3, 1000},
        Setting{"least_box", 40, {2.01, 2.01, 2.01}, thermal, 0.5, 0.05, 300, 0.3, 10000},
        Setting{"flat_box", 60, {2.01, 3.5, 7.2}, thermal, 1, 0.05, 300, 0.3, 5000},
        Setting{"long_box", 40, {100, 2.5, 2.01}, thermal, 3, 0.1, 300, 0.3, 1000},
        Setting{
            "side_next_to_whole_long", 150, {5.999, 6.001, 4}, thermal, 1, 0.02, 100, 0.3, 1500},
        Setting{"dilute_long", 60, {12, 12, 12}, thermal, 8, 0.2, 300, 0.3, 1000},
        Setting{"chained_blocks_long", 400, {4.1, 4.2, 4.3}, thermal, 0.3, 0.01, 60, 0.5, 2000},
        Setting{"racing", 80, {3, 3.1, 3.2}, from_rest_to_racing, 2, 0.1, 300, 0.3, 5000},
        Setting{"some_fast_long", 80, {3, 3.1, 3.2}, with_some_fast, 2, 0.1, 300, 0.3, 5000},
        Setting{"far_from_records", 20, {2.2, 3.3, 4.4}, thermal, 1, 2, 150, 0, 1500},
        Setting{"of_length_0p6", 100, {1.3, 2, 3}, thermal, 0.5, 0.05, 200, 0.3, 1500, {0.6}},
        Setting{"of_length_3", 40, {6.1, 7, 9}, thermal, 1, 0.1, 200, 0.3, 1000, {3}},
        Setting{
            "of_two_lengths", 80, {3, 3.1, 3.2}, thermal, 0.7, 0.05, 200, 0.3, 500, {1, 0.2, 0.2}},
        Setting{
            "of_many", 80, {4, 4.1, 4.2}, thermal, 1, 0.1, 200, 0.3, 500, {1.9, 1, 0.3, 0.3, 0.3}}),
    [](const auto& info) { return std::string(info.param.name); });

// Searches count time from a moment that they move forward when it lies 8 flights back, with a unit
// taken from the speeds at that moment; needles may be much slower or faster by then.
TEST(ContactsInALongRun, AreProposedWhileTheGasCoolsAndHeats) {
  Random random(seed);
  Speeds speeds;
  Gas gas = test::random_gas(random, 30, {3, 3, 3}, speeds);
  GasDrive drive(gas, random, test::search_choices(), 1);
  double lengths = 0;
  for (const double factor : {1.0, 0.3, 0.3, 1e-3, 1e-3, 30.0, 1e5}) {
    SCOPED_TRACE("speeds times " + std::to_string(factor) + ", seed " + std::to_string(seed));
    drive.look_ahead(1 / (speeds.sigma * std::max(1.0, factor)));
    speeds.sigma *= factor;
    for (Needle i{0}; i < gas.size(); ++i) {
      drive.strike(i, draw_velocities(random, speeds));
      ASSERT_NO_FATAL_FAILURE(drive.check(i));
    }
    drive.look_ahead(1 / speeds.sigma);
    const int flights = 60 / thin;
    for (int n = 0; n < flights; ++n) {
      const double flight = 30.0 / flights;
      lengths += flight;
      ASSERT_NO_FATAL_FAILURE(drive.advance(flight / speeds.sigma));
      ASSERT_NO_FATAL_FAILURE(drive.check_before_contact(any_needle(random, gas)));
    }
  }
  EXPECT_GT(lengths, 10 * 8);
  EXPECT_GT(drive.contacts(), 4000 / thin);
}

/// Of the cells of all searches that have some, each once: how many searches there are depends on
/// the machine's instruction sets.
std::vector<std::array<double, 3>> cell_sides(const std::vector<SearchChoice>& choices,
                                              const Gas& gas) {
  std::vector<std::array<double, 3>> sides;
  Counters counters;
  for (const SearchChoice& choice : choices) {
    const auto search = make_search(choice, gas, counters);
    if (search->grid()) sides.push_back(search->grid()->sides());
  }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  return sides;
}

// On borders of cells and of the box to the last bit, moving along axes and diagonals or not at
// all, and turning.
TEST(ContactsOnBordersOfCells, AreProposedByEverySearch) {
  const std::vector<SearchChoice> choices = test::search_choices();
  for (const double box : {2.01, 3.0, 4.0, 6.4}) {
    SCOPED_TRACE("box " + std::to_string(box) + ", seed " + std::to_string(seed));
    Random random(seed);
    constexpr std::size_t count = 60;
    Gas gas = test::gas_of(count, {box, box, box});
    const std::vector<std::array<double, 3>> sides = cell_sides(choices, gas);
    const auto on_border = [&] {
      const double side = sides[random.below(static_cast<int>(sides.size()))][0];
      const double x = side * random.below(static_cast<int>(std::lround(box / side)) + 1);
      const int pick = random.below(4);
      return pick == 0 ? std::nextafter(x, -1) : pick == 1 ? std::nextafter(x, 9) : x;
    };
    const auto step = [&] { return 0.5 * (random.below(3) - 1); };
    for (Needle i{0}; i < count; ++i) {
      const Vec3d w = vec3(random.normal_vector(random.below(3)));
      put(gas, i, {on_border(), on_border(), on_border()}, vec3(random.direction()),
          {step(), step(), step()}, w);
    }
    GasDrive drive(gas, random, choices, 1);
    ASSERT_NO_FATAL_FAILURE(drive.check_all());
    for (int n = 0; n < 100 / thin; ++n) {
      ASSERT_NO_FATAL_FAILURE(drive.advance(random.below(2) * 0.05 * box));
      ASSERT_NO_FATAL_FAILURE(drive.check(any_needle(random, gas)));
      for (int of_three = 0; of_three < 3; ++of_three) {
        ASSERT_NO_FATAL_FAILURE(drive.check_near(any_needle(random, gas)));
      }
      ASSERT_NO_FATAL_FAILURE(drive.check_before_contact(any_needle(random, gas)));
    }
    EXPECT_GT(drive.contacts(), 1500 / thin);
    EXPECT_GT(drive.near(), 2000 / thin);
  }
}

// Few needles in a box so wide that floats hold no digit of a needle length across a cell.
TEST(ContactsInAHugeBox, AreProposedByEverySearch) {
  const std::vector<SearchChoice> choices = test::search_choices();
  using Lengths = std::vector<double>;
  for (const auto& [box, lengths] : {std::pair{1e4, Lengths{1}},
                                     {1e6, Lengths{1}},
                                     {1e9, Lengths{1}},
                                     {1e4, Lengths{1, 1, 0.1, 0.1}}}) {
    SCOPED_TRACE("box " + std::to_string(box) + ", seed " + std::to_string(seed));
    Random random(seed);
    Gas gas = test::gas_of(100, {1.1 * box, 0.7 * box, box / 3}, lengths);
    const std::vector<std::array<double, 3>> sides = cell_sides(choices, gas);
    // Pairs near each other, anywhere; many across borders of cells.
    for (std::size_t n = 0; n < gas.size(); n += 2) {
      const auto anywhere = [&](int axis) {
        if (random.coin()) return gas.box.edge(axis) * random.uniform();
        const double side = sides[random.below(static_cast<int>(sides.size()))][axis];
        return side * random.below(static_cast<int>(std::lround(gas.box.edge(axis) / side)));
      };
      const Vec3d r{anywhere(0), anywhere(1), anywhere(2)};
      const test::Velocities a = draw_velocities(random, {}), b = draw_velocities(random, {});
      put(gas, Needle(n), r, vec3(random.direction()), a.v, a.w);
      put(gas, Needle(n + 1), r + vec3(random.normal_vector(0.3)), vec3(random.direction()), b.v,
          b.w);
    }
    GasDrive drive(gas, random, choices, 2);
    for (int n = 0; n < 20; ++n) {
      ASSERT_NO_FATAL_FAILURE(drive.check_all());
      ASSERT_NO_FATAL_FAILURE(drive.advance(0.05));
    }
    EXPECT_GT(drive.contacts(), 400);
  }
}

// Records replaced next to a needle, at a distance that rounding may explain or, for needles in
// nearly one plane, up to 2^-18: whether they part or close, the engine has to see them at once.
TEST(TouchingNeedles, AreProposedAtOnceByEverySearch) {
  Random random(seed);
  constexpr std::size_t count = 40;
  Gas gas = test::random_gas(random, count, {3, 4, 5}, {});
  GasDrive drive(gas, random, test::search_choices(), 1);
  for (int n = 0; n < 400 / thin; ++n) {
    SCOPED_TRACE("touch " + std::to_string(n) + ", seed " + std::to_string(seed));
    ASSERT_NO_FATAL_FAILURE(drive.advance(random.uniform(0, 0.1)));
    const Needle i = any_needle(random, gas), j((i + 1) % count);
    const Record& other = gas.records[j];
    const double elapsed = gas.clock.difference(drive.now(), other.time);
    const Vec3d u = director_after(other.flight, elapsed);
    Vec3d director = vec3(random.direction());
    if (n % 3 == 1) director = u + director * random.log_uniform(1e-9, 1e-2);
    director = normalised(director);
    const double arms[] = {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
    Vec3d r = centre_after(other.flight, elapsed) + u * arms[0] - director * arms[1];
    if (n % 3 == 2) {
      // Tip before tip in one plane.
      const Vec3d away = normalised(u + director);
      r = centre_after(other.flight, elapsed) + u * 0.5 + director * 0.5 +
          away * (0x1p-18 * random.uniform());
    }
    drive.set(i, r, director, draw_velocities(random, {}));
    ASSERT_NO_FATAL_FAILURE(drive.check(i));
  }
  // All but those of two needles at rest.
  EXPECT_GE(drive.touches(), static_cast<long>(390 / thin * drive.choices().size()));
}

// What a search says, times scaled back to the unit of the velocities.
using Said = std::vector<std::tuple<Needle, Shift, double>>;

// Velocities times 2^power and lengths times 2^size; angular velocities follow.
TEST(Searches, KnowNoUnitOfTimeOrLength) {
  const auto said = [](const SearchChoice& asked, int power, int size) {
    SearchChoice choice = asked;
    const double length = std::ldexp(1, size);
    if (choice.setup.cell_side) choice.setup.cell_side = *choice.setup.cell_side * length;
    if (choice.setup.capsule_radius) {
      choice.setup.capsule_radius = *choice.setup.capsule_radius * length;
    }
    const int slower = size - power;  // times are 2^slower as long
    Random random(seed);
    Gas gas = test::gas_of(30, {4 * length, 3 * length, 2.5 * length}, {length, 0.7 * length});
    gas.clock = Clock(std::ldexp(1.0, slower));
    for (Needle i{0}; i < gas.size(); ++i) {
      const test::Velocities drawn = draw_velocities(random, {});
      const Vec3d r{random.uniform(0, 4), random.uniform(0, 3), random.uniform(0, 2.5)};
      put(gas, i, r * length, vec3(random.direction()), drawn.v * std::ldexp(1.0, power),
          drawn.w * std::ldexp(1.0, -slower));
    }
    Counters counters;
    const auto search = make_search(choice, gas, counters);
    Said out;
    Time now;
    for (Needle i{0}; i < gas.size(); ++i) search->place(i, now);
    for (int n = 0; n < 40; ++n) {
      for (Needle i{0}; i < gas.size(); ++i) {
        const Time end = search->place(i, now);
        out.push_back({i, {}, std::ldexp(gas.clock.since_start(end), -slower)});
        const double ahead = std::min(gas.clock.difference(end, now), std::ldexp(0.5, slower));
        search->find({i, {}, now, ahead}, [&](Needle j, const Shift& shift, double from) {
          out.push_back({j, shift, std::ldexp(from, -slower)});
          return ahead;
        });
      }
      now = gas.clock.add(now, std::ldexp(0.3, slower));
    }
    return out;
  };
  for (const SearchChoice& choice : test::search_choices()) {
    const Said truth = said(choice, 0, 0);
    EXPECT_GT(truth.size(), 1200u) << choice.name();
    for (const auto& [power, size] : {std::pair{60, 0},
                                      {-60, 0},
                                      {300, 0},
                                      {-300, 0},
                                      {0, 1},
                                      {0, -5},
                                      {0, 60},
                                      {7, -60},
                                      {-300, 3}}) {
      EXPECT_EQ(said(choice, power, size), truth)
          << choice.name() << ", velocities times 2^" << power << ", lengths times 2^" << size;
    }
  }
}

// Without it searches would do more work, and say nothing wrong.
TEST(Searches, LeaveOutWhatComesAfterTheNextEventOfTheOther) {
  Random random(seed);
  Gas gas = test::random_gas(random, 1000, {5, 6, 7}, {});
  for (const SearchChoice& choice : test::search_choices()) {
    if (!choice.uses_simd()) continue;
    SCOPED_TRACE(choice.name());
    Counters counters;
    const auto search = make_search(choice, gas, counters);
    const auto proposed = [&] {
      std::size_t count = 0;
      for (Needle i{0}; i < gas.size(); ++i) {
        search->find({i, {}, {}, 1}, [&](Needle, const Shift&, double) {
          ++count;
          return 1.0;
        });
      }
      return count;
    };
    for (Needle i{0}; i < gas.size(); ++i) search->place(i, {});
    const std::size_t before = proposed();
    EXPECT_GT(before, 50u);
    for (Needle i{0}; i < gas.size(); ++i) search->set_next_event(i, {});
    EXPECT_LT(proposed(), before / 10);
  }
}

// A calendar groups needles by these.
TEST(Searches, NameTheCellsOfTheirNeedles) {
  Random random(seed);
  Gas gas = test::random_gas(random, 200, {5, 6, 7}, {});
  Gas mixture = test::random_gas(random, 300, {9, 10, 11}, {}, {4, 0.2, 0.2, 0.2});
  std::size_t placed = 0, stayed = 0;
  for (const Gas* each : {&gas, &mixture}) {
    for (const SearchChoice& choice : test::search_choices()) {
      SCOPED_TRACE(choice.name());
      Counters counters;
      const auto search = make_search(choice, *each, counters);
      EXPECT_EQ(search->name(), choice.search);
      const CellGrid* grid = search->grid();
      EXPECT_EQ(search->cells(), grid ? grid->size() : 1);
      for (Needle i{0}; i < each->size(); ++i) {
        search->place(i, {});
        ASSERT_LT(search->cell_index(i), search->cells());
        if (!grid || choice.setup.isa != kernels::Isa::scalar || !choice.uses_simd()) continue;
        const kernels::Flight& flight = each->records[i].flight;
        if (choice.search != "linked-cells") continue;
        // Its own, or one that it flies to.
        const Cell here = grid->cell_of(flight.r);
        const auto next = [](double v) { return std::signbit(v) ? -1 : 1; };
        std::set<std::size_t> cells;
        for (int ahead = 0; ahead < 8; ++ahead) {
          cells.insert(grid->index_of({here[0] + (ahead & 1 ? next(flight.v.x) : 0),
                                       here[1] + (ahead & 2 ? next(flight.v.y) : 0),
                                       here[2] + (ahead & 4 ? next(flight.v.z) : 0)}));
        }
        ASSERT_TRUE(cells.contains(search->cell_index(i)));
        stayed += search->cell_index(i) == grid->index_of(here);
        ++placed;
      }
    }
  }
  // A fifth of a side is near a border.
  EXPECT_GT(stayed, placed / 3);
  EXPECT_LT(stayed, placed * 9 / 10);
}

TEST(CellGrids, FitTheSideThatIsAskedFor) {
  const auto counts = [](CellFit fit) {
    return CellGrid({12, 11.4, 0.3}, 1.01, 20000, {1, 1, 1}, 2, fit).counts();
  };
  using Counts = std::array<std::int32_t, 3>;
  EXPECT_EQ(counts(CellFit::at_least), (Counts{11, 11, 1}));
  EXPECT_EQ(counts(CellFit::nearest), (Counts{12, 11, 1}));
}

// Against distances in double, also where an interval is longer than the box and where lengths are
// in other units.
TEST(CellGrids, FindTheCellsNearAnInterval) {
  Random random(seed);
  std::vector<CellGrid::AxisCell> found;
  for (int trial = 0; trial < 2000; ++trial) {
    const int axis = trial % 3, origin = static_cast<int>(40 * random.uniform()) - 20;
    const double edge = 1 + 9 * random.uniform(), per_length = std::ldexp(1.0, trial % 5 * 10 - 20);
    const CellGrid grid({edge, edge, edge}, 0.9 + 2 * random.uniform(), 100);
    const double side = grid.sides()[axis];
    const double low = 4 * random.uniform() - 2, high = low + 3 * random.uniform();
    const double reach = 2 * random.uniform();
    const auto unit = [&](double length) { return static_cast<float>(length * per_length); };
    const std::size_t count =
        grid.find_near(axis, origin, unit(low), unit(high), unit(reach), per_length, found);
    ASSERT_LE(count, found.size());
    std::size_t next = 0;
    for (int cell = origin - 20; cell <= origin + 20; ++cell) {
      const double corner = (cell - origin) * side;
      const double gap = std::max({0.0, corner - high, low - (corner + side)});
      const bool is_found = next < count && found[next].cell == cell;
      if (std::abs(gap - reach) > 1e-5) {
        ASSERT_EQ(is_found, gap < reach) << gap << ", " << reach;
      }
      if (!is_found) continue;
      const CellGrid::AxisCell& one = found[next++];
      EXPECT_EQ(one.wrapped, grid.wrap(cell, axis));
      EXPECT_NEAR(one.offset, corner * per_length, 1e-5 * per_length);
      EXPECT_NEAR(std::sqrt(one.gap_squared), gap * per_length, 1e-5 * per_length);
    }
    EXPECT_EQ(next, count);
  }
}

TEST(LinkedListsLayout, HasCellsNoSmallerThanANeedle) {
  const auto counts = [](std::size_t needles, std::array<double, 3> box) {
    Counters counters;
    return LinkedLists(test::gas_of(needles, box), counters, {}).grid().counts();
  };
  using Counts = std::array<std::int32_t, 3>;
  EXPECT_EQ(counts(1000, {2.01, 3.5, 7}), (Counts{2, 3, 6}));  // 7 cells of side 1 have no margin
  EXPECT_EQ(counts(100000, {24, 24, 24.01}), (Counts{23, 23, 24}));
  // Two cells for each needle are enough.
  EXPECT_EQ(counts(4, {20, 20, 20}), (Counts{2, 2, 2}));
  const Counts dilute = counts(1000, {100, 100, 100});
  for (const std::int32_t n : dilute) EXPECT_LE(n, 13);
}

// Up to a quarter more.
TEST(Cells, ComeInMultiplesThatAreNear) {
  const auto counts = [](std::array<std::int32_t, 3> multiples) {
    return CellGrid({24, 24, 24}, 2.3, 10000, multiples).counts();
  };
  using Counts = std::array<std::int32_t, 3>;
  EXPECT_EQ(counts({1, 1, 1}), (Counts{10, 10, 10}));
  EXPECT_EQ(counts({2, 3, 4}), (Counts{10, 12, 12}));
  EXPECT_EQ(counts({7, 5, 13}), (Counts{10, 10, 10}));
}

// Whatever side is asked for, and however thin the box.
TEST(Cells, AreNotManyMoreThanNeedles) {
  const auto cells = [](std::array<double, 3> box, double side, std::size_t needles) {
    return static_cast<double>(CellGrid(box, side, needles).size());
  };
  EXPECT_EQ(cells({40, 40, 40}, 2, 1000), 8000);
  EXPECT_EQ(cells({3, 4, 5}, 1e9, 1000), 1);
  for (const double box : {1e2, 1e5, 1e9}) {
    for (const std::size_t needles : {0, 20, 100000}) {
      const double n = static_cast<double>(needles);
      EXPECT_LT(cells({box, box, box}, 0.1, needles), 5e3 + 20 * n) << box;
      EXPECT_LT(cells({2.01, box, 2.01}, 0.1, needles), 5e3 + 20 * n) << box;
      EXPECT_GT(cells({box, box, box}, 0.1, needles), 1e3 + 5 * n) << box;
    }
  }
}

}  // namespace
}  // namespace needlework
