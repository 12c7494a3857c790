// Every search against all needles and all their images, while the needles move, cross cells,
// collide and are renewed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "src/search/all_pairs.h"
#include "src/search/linked_cells.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"

namespace needlework {
namespace {

using test::Random;
using test::vec3;

constexpr std::uint64_t seed = 1515;
constexpr int most_events = 6000;
#ifdef NDEBUG
constexpr int events = most_events;
#else
constexpr int events = 600;
#endif

/// Fewer when checking many needles is slow; a few far apart meet too seldom for less than all.
int events_among(Needle count) {
  return std::clamp(300 * events / static_cast<int>(count), events, most_events);
}

using Candidate = std::pair<Needle, Shift>;

std::array<double, 3> components(const Vec3d& a) { return {a.x, a.y, a.z}; }

Gas gas_of(Needle count, std::array<double, 3> box) {
  Gas gas;
  gas.records.resize(count);
  gas.ids.resize(count);
  gas.images.resize(count);
  gas.box = box;
  return gas;
}

Vec3d centre(const Gas& gas, Needle i, Time now) {
  const Record& record = gas.records[i];
  return centre_after(record.flight, gas.clock.difference(now, record.time));
}

/// All images of all other needles with centres nearer than L at this time, beyond rounding.
std::vector<Candidate> within_reach(const Gas& gas, Needle i, Time now) {
  std::vector<Candidate> out;
  const auto mine = components(centre(gas, i, now));
  for (Needle j = 0; j < gas.size(); ++j) {
    if (j == i) continue;
    const auto other = components(centre(gas, j, now));
    std::array<double, 3> r;
    Shift nearest;
    for (int axis = 0; axis < 3; ++axis) {
      r[axis] = mine[axis] - other[axis];
      nearest[axis] = static_cast<std::int32_t>(std::lround(r[axis] / gas.box[axis]));
    }
    for (int n = 0; n < 27; ++n) {
      const Shift shift = nearest + Shift{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      double square = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double d = r[axis] - shift[axis] * gas.box[axis];
        square += d * d;
      }
      if (square < 1 - 1e-12) out.push_back({j, shift});
    }
  }
  return out;
}

/// Takes a search through the events that an event loop would.
template <class Search>
class Drive {
 public:
  Drive(Gas& gas, Random& random) : gas_(gas), random_(random), search_(gas) {
    const auto count = static_cast<Needle>(gas.size());
    next_.resize(count);
    for (Needle i = 0; i < count; ++i) search_.insert(i, now_);
    for (Needle i = 0; i < count; ++i) schedule(i);
  }

  /// The earliest event: a needle leaves its cell or its record has to be renewed. Or, now and
  /// then before it, a collision.
  void step(double collisions) {
    const auto it = std::min_element(next_.begin(), next_.end());
    const auto i = static_cast<Needle>(it - next_.begin());
    if (random_.uniform() < collisions || *it == Time::never()) {
      now_ = between(now_, std::min(*it, gas_.clock.add(now_, 0.1)));
      const auto j = static_cast<Needle>(random_.below(static_cast<int>(gas_.size())));
      replace(j, vec3(random_.normal_vector(random_.below(5) == 0 ? 0 : 1)));
      schedule(j);
      return;
    }
    now_ = *it;
    if (gas_.records[i].renewal <= now_) replace(i, gas_.records[i].flight.v);
    crossings_ += search_.move_on(i, now_);
    schedule(i);
  }

  /// The candidates of i are complete and without repetition, now and until its next event or that
  /// of any other needle.
  void check(Needle i) {
    const Time until =
        std::min(*std::min_element(next_.begin(), next_.end()), gas_.clock.add(now_, 0.05));
    std::map<Candidate, int> proposed;
    search_.for_each_candidate(i, now_, until, [&](Needle j, const Shift& shift) {
      ++proposed[{j, shift}];
    });
    for (const auto& [candidate, times] : proposed) {
      ASSERT_EQ(times, 1) << "needle " << candidate.first;
      ASSERT_NE(candidate.first, i);
    }
    for (const Time t : {now_, between(now_, until), until}) {
      for (const Candidate& candidate : within_reach(gas_, i, t)) {
        ++seen_;
        ASSERT_TRUE(proposed.contains(candidate))
            << "needle " << i << " lacks " << candidate.first << " at time "
            << gas_.clock.since_start(t) << " of " << gas_.clock.since_start(now_) << " .. "
            << gas_.clock.since_start(until);
      }
    }
  }

  void check_all() {
    for (Needle i = 0; i < gas_.size(); ++i) ASSERT_NO_FATAL_FAILURE(check(i));
  }

  long crossings() const { return crossings_; }
  long seen() const { return seen_; }
  Search& search() { return search_; }

 private:
  Time between(Time a, Time b) {
    return std::min(b, gas_.clock.add(a, random_.uniform() * gas_.clock.difference(b, a)));
  }
  void replace(Needle i, const Vec3d& v) {
    search_.rewrap(i, renew_record(gas_, i, now_, {1, 0, 0}, v, {}));
  }
  void schedule(Needle i) {
    next_[i] = std::min(search_.complete_until(i, now_), gas_.records[i].renewal);
  }

  Gas& gas_;
  Random& random_;
  Search search_;
  std::vector<Time> next_;
  Time now_;
  long crossings_ = 0, seen_ = 0;
};

template <class Search>
class SearchTest : public testing::Test {};

using Searches = testing::Types<AllPairs, LinkedCells>;

struct Names {
  template <class Search>
  static std::string GetName(int) {
    std::string name = Search::name;
    for (char& c : name) c = c == '-' ? '_' : c;
    return name;
  }
};
TYPED_TEST_SUITE(SearchTest, Searches, Names);

struct Filled {
  Needle count;
  std::array<double, 3> box;
};

std::vector<Filled> fillings() {
  return {{1, {3, 3, 3}},        {2, {2.01, 2.01, 2.01}}, {40, {2.01, 2.01, 2.01}},
          {2, {2, 2, 2}},        {60, {2.01, 3.5, 7.2}},  {60, {12.3, 2, 3.001}},
          {200, {6, 6, 6}},      {30, {30, 30, 30}},      {300, {5.999, 6.001, 4}},
          {20, {100, 2.5, 2.01}}};
}

TYPED_TEST(SearchTest, ProposesAllThatComeNearWhileNeedlesMove) {
  for (const Filled& filled : fillings()) {
    SCOPED_TRACE(std::to_string(filled.count) + " needles in " + std::to_string(filled.box[0]) +
                 " x " + std::to_string(filled.box[1]) + " x " + std::to_string(filled.box[2]) +
                 ", seed " + std::to_string(seed));
    Random random(seed);
    Gas gas = gas_of(filled.count, filled.box);
    for (Needle i = 0; i < filled.count; ++i) {
      gas.records[i].flight =
          test::flight({random.uniform(-0.2, 1.2) * filled.box[0], random.uniform() * filled.box[1],
                        random.uniform() * filled.box[2]},
                       {1, 0, 0}, {}, {});
      renew_record(gas, i, {}, {1, 0, 0}, vec3(random.normal_vector(random.log_uniform(1e-3, 10))),
                   {});
    }
    Drive<TypeParam> drive(gas, random);
    ASSERT_NO_FATAL_FAILURE(drive.check_all());
    const int events = events_among(filled.count);
    for (int n = 0; n < events; ++n) {
      drive.step(0.3);
      ASSERT_NO_FATAL_FAILURE(
          drive.check(static_cast<Needle>(random.below(static_cast<int>(gas.size())))))
          << "event " << n;
    }
    ASSERT_NO_FATAL_FAILURE(drive.check_all());
    if (filled.count > 2) {
      EXPECT_GT(drive.seen(), events / 100);
    }
    if (TypeParam::name == LinkedCells::name) {
      EXPECT_GT(drive.crossings(), events / 3);
    }
  }
}

// Records live for 2^10 lengths: without collisions needles leave the box far behind.
TYPED_TEST(SearchTest, ProposesAllThatComeNearFarFromTheirRecords) {
  Random random(seed);
  Gas gas = gas_of(20, {2.2, 3.3, 4.4});
  for (Needle i = 0; i < 20; ++i) {
    gas.records[i].flight =
        test::flight({random.uniform(0, 2.2), random.uniform(0, 3.3), random.uniform(0, 4.4)},
                     {1, 0, 0}, {}, {});
    renew_record(gas, i, {}, {1, 0, 0}, vec3(random.normal_vector(1)), {});
  }
  Drive<TypeParam> drive(gas, random);
  for (int n = 0; n < 10 * events; ++n) {
    drive.step(0);
    if (n % 20 == 0) {
      ASSERT_NO_FATAL_FAILURE(drive.check(static_cast<Needle>(random.below(20))));
    }
  }
}

// On borders of cells and of the box, moving along axes and diagonals, or not at all.
TYPED_TEST(SearchTest, ProposesAllThatComeNearFromBordersOfCells) {
  for (const double box : {2.0, 2.01, 3.0, 4.0, 6.4}) {
    SCOPED_TRACE("box " + std::to_string(box) + ", seed " + std::to_string(seed));
    Random random(seed);
    constexpr Needle count = 60;
    Gas gas = gas_of(count, {box, box, box});
    const double side = box / LinkedCells(gas).counts()[0];
    const auto on_border = [&] {
      const double x = side * random.below(static_cast<int>(std::lround(box / side)) + 1);
      const int pick = random.below(4);
      return pick == 0 ? std::nextafter(x, -1) : pick == 1 ? std::nextafter(x, 9) : x;
    };
    for (Needle i = 0; i < count; ++i) {
      gas.records[i].flight =
          test::flight({on_border(), on_border(), on_border()}, {1, 0, 0}, {}, {});
      const auto step = [&] { return 0.5 * (random.below(3) - 1); };
      renew_record(gas, i, {}, {1, 0, 0}, {step(), step(), step()}, {});
    }
    Drive<TypeParam> drive(gas, random);
    ASSERT_NO_FATAL_FAILURE(drive.check_all());
    for (int n = 0; n < events; ++n) {
      drive.step(0.02);
      if (n % 5 == 0) {
        ASSERT_NO_FATAL_FAILURE(drive.check(static_cast<Needle>(random.below(count))))
            << "event " << n;
      }
    }
    ASSERT_NO_FATAL_FAILURE(drive.check_all());
  }
}

TYPED_TEST(SearchTest, KnowsNoUnitOfTime) {
  const auto crossings = [](int power) {
    Random random(seed);
    Gas gas = gas_of(10, {4, 5, 6});
    gas.clock = Clock(std::ldexp(1.0, power));
    for (Needle i = 0; i < 10; ++i) {
      gas.records[i].flight = test::flight(
          {random.uniform(0, 4), random.uniform(0, 5), random.uniform(0, 6)}, {1, 0, 0}, {}, {});
      renew_record(gas, i, {}, {1, 0, 0}, vec3(random.normal_vector(1)) * std::ldexp(1.0, -power),
                   {});
    }
    TypeParam search(gas);
    for (Needle i = 0; i < 10; ++i) search.insert(i, {});
    std::vector<std::pair<std::int64_t, double>> out;
    Time now;
    for (int n = 0; n < 50; ++n) {
      for (Needle i = 0; i < 10; ++i) {
        const Time end = search.complete_until(i, now);
        out.push_back({end.epoch, std::ldexp(end.offset, -power)});
        search.move_on(i, now);
      }
      now = gas.clock.add(now, std::ldexp(0.01, power));
    }
    return out;
  };
  EXPECT_EQ(crossings(60), crossings(0));
  EXPECT_EQ(crossings(-60), crossings(0));
}

TEST(LinkedCellsLayout, HasCellsNoSmallerThanANeedle) {
  const auto counts = [](Needle needles, std::array<double, 3> box) {
    return LinkedCells(gas_of(needles, box)).counts();
  };
  using Counts = std::array<std::int32_t, 3>;
  EXPECT_EQ(counts(1000, {2.01, 3.5, 7}), (Counts{2, 3, 6}));  // 7 cells of side 1 have no margin
  EXPECT_EQ(counts(1000, {2, 2, 2}), (Counts{2, 2, 2}));
  EXPECT_EQ(counts(100000, {24, 24, 24.01}), (Counts{23, 23, 24}));
  // One cell for two needles' worth of volume is enough.
  EXPECT_EQ(counts(4, {20, 20, 20}), (Counts{2, 2, 2}));
  const Counts dilute = counts(1000, {100, 100, 100});
  for (const std::int32_t n : dilute) EXPECT_LE(n, 13);
}

}  // namespace
}  // namespace needlework
