// Bounding volumes by themselves, without the filters behind them, which would hide errors that
// cost no contact: a needle stays in its bounding volume for as long as place() says, and all
// needles whose bounding volumes come near are found. How near and how long is tight, so that
// neither holds only because bounding volumes are too large.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>
#include <string>

#include "kernels/closest_approach.h"
#include "src/search/near_search.h"
#include "tests/search/gas_drive.h"
#include "tests/support/by_build.h"
#include "tests/support/kernel_pair.h"

namespace needlework::test {

// Of shifts.
using needlework::operator-;
using needlework::operator+;

namespace {

constexpr std::uint64_t seed = 77;
constexpr int steps = test::by_build(400, 100);

struct Cloud {
  const char* name;
  std::size_t needles;
  std::array<double, 3> box;
  Speeds speeds;
  SearchSetup setup;
};

void PrintTo(const Cloud& setting, std::ostream* out) { *out << setting.name; }

SearchSetup sized(std::optional<double> cell_side, std::optional<double> capsule_radius) {
  return {.density = {},
          .cell_side = cell_side,
          .capsule_radius = capsule_radius,
          .float_filter = false};
}

const Cloud settings[] = {
    {"dilute", 120, {6, 6, 6}, {}, sized({}, {})},
    {"dense", 400, {3, 3, 3}, {}, sized({}, {})},
    {"least_box", 30, {2.01, 2.01, 2.01}, {}, sized({}, 0.3)},
    {"slab", 200, {9, 2.5, 4}, {.fast = 30, .slow = 1e-3}, sized(1.3, 0.15)},
    {"small_cells", 200, {5, 5, 5}, {}, sized(0.3, 0.05)},
    {"large_capsules", 60, {4, 4, 4}, {}, sized(3, 1)},
    {"swift", 150, {5, 5, 5}, {.sigma = 1e6}, sized({}, {})},
};

struct Segment {
  Vec3d r, u;
};

Segment needle_at(const Gas& gas, Needle i, Time t) {
  const Record& record = gas.records[i];
  const double elapsed = gas.clock.difference(t, record.time);
  return {centre_after(record.flight, elapsed), director_after(record.flight, elapsed)};
}

double distance(const Vec3d& point, const Segment& axis) {
  const Vec3d d = point - axis.r;
  const Vec3d off = d - axis.u * std::clamp(dot(d, axis.u) / dot(axis.u, axis.u), -0.5, 0.5);
  return std::sqrt(dot(off, off));
}

double distance(const Segment& a, const Segment& b) {
  const Vec3d x = cross(a.u, b.u);
  return std::sqrt(kernels::segment_distance_squared(a.r - b.r, a.u, b.u, x, dot(x, x),
                                                     kernels::half_lengths(0.5, 0.5)));
}

// The least distance of two centres in the next `span`.
double least_distance(const Vec3d& r, const Vec3d& v, double span) {
  const double vv = dot(v, v);
  const double t = vv > 0 ? std::clamp(-dot(r, v) / vv, 0.0, span) : 0;
  const Vec3d d = r + v * t;
  return std::sqrt(dot(d, d));
}

// A search in a gas whose needles are placed when their times come.
struct Moving {
  Moving(const Cloud& setting, BoundingVolume volume, Random& draws)
      : random(draws),
        gas(random_gas(draws, setting.needles, setting.box, setting.speeds)),
        search(gas, counters, setting.setup, volume),
        until(gas.size()) {
    for (Needle i{0}; i < gas.size(); ++i) place(i);
  }

  void advance(double dt) {
    const Time end = gas.clock.add(now, dt);
    for (;;) {
      const auto next = std::min_element(until.begin(), until.end());
      if (*next > end) break;
      now = *next;
      place(Needle(next - until.begin()));
    }
    now = end;
  }
  void place(Needle i) { until[i] = search.place(i, now, lengths.half_length(i)); }
  Needle any() { return Needle(random.below(static_cast<int>(gas.size()))); }
  double left(Needle i) const { return std::min(gas.clock.difference(until[i], now), 1e3); }

  Segment axis(Needle i) const {
    const ClassCells& volumes = search.volumes().class_of(i);
    const BoundingVolumes::Place& place = search.volumes().places[i];
    const kernels::NeedleBlock& block = volumes.cells[place.slot.block];
    EXPECT_EQ(block.needle[place.slot.lane], i);
    const auto coordinate = [&](int axis) {
      return volumes.format.coordinate(block.word[axis][place.slot.lane]);
    };
    const auto director = [&](int axis) {
      return double{kernels::WordFormat::director(block.word[axis][place.slot.lane])};
    };
    return {volumes.grid.corner(place.cell) + Vec3d{coordinate(0), coordinate(1), coordinate(2)},
            {director(0), director(1), director(2)}};
  }

  std::set<Candidate> found(Needle i, double ahead) {
    std::set<Candidate> out;
    search.find({i, {}, now, ahead}, lengths, [&](Needle j, const Shift& shift, double) {
      EXPECT_TRUE(out.insert({j, shift}).second) << "proposed twice";
      return ahead;
    });
    return out;
  }

  template <class Visit>
  void for_each_image(Needle i, Visit&& visit) const {
    const Vec3d mine = needle_at(gas, i, now).r;
    for (Needle j{0}; j < gas.size(); ++j) {
      if (j == i) continue;
      const Vec3d d = mine - needle_at(gas, j, now).r;
      const auto nearest = [&](double a, int axis) {
        return static_cast<std::int32_t>(std::round(a / gas.box.edge(axis)));
      };
      for (std::int32_t z = -2; z <= 2; ++z) {
        for (std::int32_t y = -2; y <= 2; ++y) {
          for (std::int32_t x = -2; x <= 2; ++x) {
            const Shift shift{nearest(d.x, 0) + x, nearest(d.y, 1) + y, nearest(d.z, 2) + z};
            visit(j, shift,
                  Vec3d{shift[0] * gas.box.edge(0), shift[1] * gas.box.edge(1),
                        shift[2] * gas.box.edge(2)});
          }
        }
      }
    }
  }

  Random& random;
  Gas gas;
  BodyLengths lengths{gas};
  Counters counters;
  NearSearch search;
  std::vector<Time> until;
  Time now;
};

// How far a needle is out of the middle of its bounding volume, as a share of what it may be.
double share_of_capsule(const Moving& moving, Needle i, Time t) {
  const Segment needle = needle_at(moving.gas, i, t), axis = moving.axis(i);
  const double off = std::max(distance(needle.r + needle.u * 0.5, axis),
                              distance(needle.r - needle.u * 0.5, axis));
  const ClassCells& volumes = moving.search.volumes().class_of(i);
  return (off - volumes.margin - volumes.format.step()) / moving.search.radius();
}
double share_of_cell(const Moving& moving, Needle i, Time t) {
  const ClassCells& volumes = moving.search.volumes().class_of(i);
  const Cell& cell = moving.search.volumes().places[i].cell;
  const Vec3d r = needle_at(moving.gas, i, t).r - volumes.grid.corner(cell);
  const auto sides = volumes.grid.sides();
  double share = 0;
  const double at[3] = {r.x, r.y, r.z};
  for (int axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * sides[axis];
    share =
        std::max(share, (std::abs(at[axis] - half) - volumes.margin) / (half + volumes.overlap));
  }
  return share;
}

// How far from where a needle is it has been placed, as a share of what several threads lock for
// it: its cell, along the axis along which it is farthest.
double share_of_lock(const Moving& moving, Needle i) {
  const ClassCells& volumes = moving.search.volumes().class_of(i);
  const Vec3d r = needle_at(moving.gas, i, moving.now).r -
                  volumes.grid.corner(moving.search.volumes().places[i].cell);
  const auto sides = volumes.grid.sides();
  const double at[3] = {r.x, r.y, r.z};
  double farthest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    farthest = std::max({farthest, -at[axis], at[axis] - sides[axis]});
  }
  return std::max(0.0, farthest - volumes.margin) / moving.search.radius();
}

void expect_held(BoundingVolume volume, const Cloud& setting, double fullest) {
  Random random(seed);
  Moving moving(setting, volume, random);
  const auto share_of = volume == BoundingVolume::cell ? share_of_cell : share_of_capsule;
  const double step = 0.1 / setting.speeds.sigma;
  double most = 0, farthest = 0;
  for (int n = 0; n < steps; ++n) {
    moving.advance(step * random.uniform());
    for (int k = 0; k < 20; ++k) {
      const Needle i = moving.any();
      if (k % 2 == 0) {
        moving.place(i);
        const double share = share_of_lock(moving, i);
        ASSERT_LE(share, 1) << "needle " << i << " is placed too far away, step " << n;
        farthest = std::max(farthest, share);
      }
      for (const double part : {0.0, random.uniform(), 1.0}) {
        const Time t = moving.gas.clock.add(moving.now, part * moving.left(i));
        const double share = share_of(moving, i, std::min(t, moving.until[i]));
        ASSERT_LE(share, 1) << "needle " << i << " has left its bounding volume, step " << n;
        most = std::max(most, share);
      }
    }
  }
  EXPECT_GT(most, fullest);
  EXPECT_GT(farthest, volume == BoundingVolume::cell ? 0.9 : 0.5);
}

// Of each pair: how near its bounding volumes are, and within what they have to be found.
struct Nearness {
  double here, within;
};
Nearness of_capsules(const Moving& moving, Needle i, Needle j, const Vec3d& image, double) {
  Segment other = moving.axis(j);
  other.r += image;
  return {distance(moving.axis(i), other), 2 * moving.search.radius()};
}
// What comes near after one of the two has been placed again is found then.
Nearness of_cells(const Moving& moving, Needle i, Needle j, const Vec3d& image, double ahead) {
  const Vec3d r =
      needle_at(moving.gas, i, moving.now).r - (needle_at(moving.gas, j, moving.now).r + image);
  const Vec3d v = moving.gas.records[i].flight.v - moving.gas.records[j].flight.v;
  return {least_distance(r, v, std::min(ahead, moving.left(j))), 1};
}

void expect_found(BoundingVolume volume, const Cloud& setting) {
  Random random(seed + 1);
  Moving moving(setting, volume, random);
  const auto nearness = volume == BoundingVolume::cell ? of_cells : of_capsules;
  const double step = 0.1 / setting.speeds.sigma;
  long near = 0, spare = 0;
  for (int n = 0; n < steps; ++n) {
    moving.advance(step * random.uniform());
    const Needle i = moving.any();
    moving.place(i);
    const double ahead = moving.left(i) * (random.coin() ? 1 : random.uniform());
    const std::set<Candidate> found = moving.found(i, ahead);
    moving.for_each_image(i, [&](Needle j, const Shift& shift, const Vec3d& image) {
      const Nearness pair = nearness(moving, i, j, image, ahead);
      const bool proposed = found.contains({j, shift});
      near += pair.here < pair.within;
      const ClassCells& volumes = moving.search.volumes().class_of(i);
      const double margin = 8 * volumes.margin + 4 * volumes.format.step();
      spare += proposed && pair.here > 1.01 * pair.within + margin;
      ASSERT_TRUE(proposed || pair.here >= pair.within)
          << "needles " << i << " and " << j << " at " << pair.here << ", step " << n;
    });
  }
  EXPECT_GT(near, steps / 4);
  // Linked cells do not look at when the other one will be placed again.
  if (volume == BoundingVolume::capsule) {
    EXPECT_EQ(spare, 0);
  }
  EXPECT_LT(spare, near);
}

class BoundingVolumesOf : public testing::TestWithParam<Cloud> {};

TEST_P(BoundingVolumesOf, CellsHoldTheirNeedles) {
  expect_held(BoundingVolume::cell, GetParam(), 0.999);
}
TEST_P(BoundingVolumesOf, CapsulesHoldTheirNeedles) {
  expect_held(BoundingVolume::capsule, GetParam(), 0.9);
}
TEST_P(BoundingVolumesOf, CellsFindAllThatComeNear) {
  expect_found(BoundingVolume::cell, GetParam());
}
TEST_P(BoundingVolumesOf, CapsulesFindAllThatComeNear) {
  expect_found(BoundingVolume::capsule, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Settings, BoundingVolumesOf, testing::ValuesIn(settings),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace needlework::test
