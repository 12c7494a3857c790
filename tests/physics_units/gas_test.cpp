// Records: their renewal, their images in the box, and what a pair takes from them.
#include "src/physics/gas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "needlework/theory.h"
#include "src/physics/mean_free_time.h"
#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"
#include "tests/support/real.h"
#include "tests/support/renew.h"

namespace needlework {
namespace {

using test::Random;
using test::renew_in_flight;
using test::vec3;
using test::Wide;

constexpr std::uint64_t seed = 1111;
constexpr int count = 3000;

// Their ids are their places.
Gas gas_of(std::uint32_t needles, std::array<double, 3> box) {
  Gas gas;
  gas.records.resize(needles);
  for (std::uint32_t id = 0; id < needles; ++id) gas.ids.push_back({id});
  gas.images.resize(needles);
  gas.box = box;
  return gas;
}

constexpr Needle needle{0}, partner{1};

std::array<double, 3> components(const Vec3d& a) { return {a.x, a.y, a.z}; }

TEST(RenewRecord, WrapsTheCentreAndCountsTheImages) {
  Random random(seed);
  const std::array<double, 3> box{2.5, 7.3, 100.1};
  Gas gas = gas_of(1, box);
  gas.records[0].flight = test::flight({1, 2, 3}, {1, 0, 0}, {}, {});
  std::array<Wide, 3> free{1, 2, 3};  // where it would be without walls
  for (int n = 0; n < count; ++n) {
    const double dt = random.uniform(0, 3);
    const Vec3d v = gas.records[0].flight.v;
    const Time now = gas.clock.add(gas.records[0].time, dt);
    const double elapsed = gas.clock.difference(now, gas.records[0].time);
    const Shift images = gas.images[0];
    const Shift wraps =
        renew_in_flight(gas, needle, now, {0, 1, 0}, {vec3(random.normal_vector(20)), {}});
    ASSERT_EQ(gas.images[0], images + wraps);
    const auto r = components(gas.records[0].flight.r), speed = components(v);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(r[axis], 0) << "seed " << seed << ", step " << n;
      ASSERT_LE(r[axis], box[axis]) << "seed " << seed << ", step " << n;
      free[axis] += Wide(speed[axis]) * elapsed;
      const Wide here = r[axis] + Wide(gas.images[0][axis]) * box[axis];
      ASSERT_LT(abs(here - free[axis]), 1e-13 * (n + 1) * box[axis]) << "seed " << seed;
    }
    ASSERT_EQ(gas.records[0].time, now);
    ASSERT_EQ(gas.records[0].serial, static_cast<std::uint32_t>(n + 1));
  }
  EXPECT_NE(gas.images[0], Shift{});
}

TEST(RenewRecord, WrapsCentresOnAndNextToTheWallsWithoutLosingTheirPlace) {
  const double box = 2.5;
  for (const double x : {0.0, -0.0, box, -box, 2 * box, std::nextafter(box, 0),
                         std::nextafter(box, 3), -1e-18, -1e-300, 1e-300, -1e9}) {
    Gas gas = gas_of(1, {box, box, box});
    gas.records[0].flight = test::flight({x, 1, 1}, {1, 0, 0}, {}, {});
    const Shift wraps = renew_in_flight(gas, needle, {}, {1, 0, 0});
    const double r = gas.records[0].flight.r.x;
    EXPECT_GE(r, 0) << x;
    EXPECT_LE(r, box) << x;
    EXPECT_LE(abs(Wide(r) + Wide(wraps[0]) * box - x), 0x1p-53 * box) << x;
    EXPECT_EQ(gas.records[0].flight.r.y, 1);
    EXPECT_EQ(wraps[1], 0);
  }
}

TEST(RenewRecord, LeavesAUnitDirectorAndAnAngularVelocityNormalToIt) {
  Random random(seed);
  Gas gas = gas_of(1, {5, 5, 5});
  for (int n = 0; n < count; ++n) {
    const double size = random.log_uniform(1e-300, 1e300), spin = random.log_uniform(1e-100, 1e100);
    const Vec3d director = vec3(random.direction()) * size, w = vec3(random.direction()) * spin;
    const Vec3d v = vec3(random.direction());
    gas.add_touch(needle, {});
    renew_in_flight(gas, needle, {}, director, {v, w});
    const kernels::Flight& flight = gas.records[0].flight;
    ASSERT_NEAR(dot(flight.u, flight.u), 1, 1e-15) << "seed " << seed << ", " << n;
    ASSERT_NEAR(dot(flight.w * (1 / spin), flight.u), 0, 1e-15) << "seed " << seed << ", " << n;
    ASSERT_NEAR(flight.omega / spin, std::sqrt(dot(flight.w * (1 / spin), flight.w * (1 / spin))),
                1e-15);
    ASSERT_NEAR(dot(flight.p, flight.p), 1, 1e-15);
    ASSERT_EQ(flight.v, v);
    ASSERT_EQ(gas.records[0].touch_count, 0);
    // Nothing is taken from w but its part along u.
    const Vec3d along = normalised(director) * dot(w, normalised(director));
    const Vec3d lost = (w - along - flight.w) * (1 / spin);
    ASSERT_LT(std::sqrt(dot(lost, lost)), 1e-15);
  }
}

TEST(RenewRecord, FromItsOwnFreeFlightChangesNothingButRounding) {
  Random random(seed);
  Gas gas = gas_of(1, {5, 5, 5});
  for (int n = 0; n < count; ++n) {
    Record& record = gas.records[0];
    record.flight = test::flight(vec3(random.normal_vector(1)), vec3(random.direction()),
                                 vec3(random.normal_vector(1)), vec3(random.normal_vector(3)));
    const kernels::Flight before = record.flight;
    const Time now = gas.clock.add(record.time, random.uniform(0, 2));
    const double elapsed = gas.clock.difference(now, record.time), later = random.uniform(0, 2);
    renew_in_flight(gas, needle, now, director_after(before, elapsed), {before.v, before.w});
    const Vec3d u = director_after(record.flight, later) - director_after(before, elapsed + later);
    ASSERT_LT(std::sqrt(dot(u, u)), 1e-14) << "seed " << seed << ", " << n;
  }
}

TEST(RenewalTime, IsAboutAThousandLengthsOrRadiansAhead) {
  Random random(seed);
  Record record;
  for (int n = 0; n < count; ++n) {
    record.flight = test::flight({}, vec3(random.direction()), vec3(random.normal_vector(1)),
                                 vec3(random.normal_vector(random.uniform(0, 5))));
    Gas gas;
    gas.clock = Clock(random.log_uniform(0.1, 10));
    const double life = gas.clock.difference(renewal_time(gas, record, 1), record.time);
    const auto [x, y, z] = components(record.flight.v);
    const double speed = std::max({std::abs(x), std::abs(y), std::abs(z), record.flight.omega});
    ASSERT_GE(life * speed, 0x1p10) << "seed " << seed << ", " << n;
    ASSERT_LT(life * speed, 0x1p11) << "seed " << seed << ", " << n;
    // Below the range in which sine and cosine are accurate.
    ASSERT_LE(life * record.flight.omega, 0x1p12);
    for (const int power : {-60, 60}) {
      Record slow = record;
      for (Vec3d* a : {&slow.flight.v, &slow.flight.w}) {
        *a = *a * std::ldexp(1.0, -power);
      }
      set_rotation(slow.flight);
      Gas slower;
      slower.clock = Clock(std::ldexp(gas.clock.epoch_length(), power));
      const Time a = renewal_time(gas, record, 1), b = renewal_time(slower, slow, 1);
      ASSERT_EQ(a.epoch, b.epoch);
      ASSERT_EQ(std::ldexp(a.offset, power), b.offset);
    }
  }
  record.flight = test::flight({}, {1, 0, 0}, {}, {});
  EXPECT_EQ(renewal_time(Gas(), record, 1), Time::never());
}

TEST(MakePair, StartsAtTheLaterRecord) {
  Gas gas = gas_of(2, {3, 4, 5});
  gas.clock = Clock(1);
  gas.records[0].time = {5, 0.25};
  gas.records[1].time = {7, 0.5};
  const Shift shift{1, 0, -2};
  const kernels::Pair pair = make_pair(gas, needle, gas.records[0], partner, gas.records[1], shift);
  EXPECT_EQ(pair.first, &gas.records[0].flight);
  EXPECT_EQ(pair.second, &gas.records[1].flight);
  EXPECT_EQ(pair.elapsed_first, DoubleDouble(2.25));
  EXPECT_EQ(pair.elapsed_second, DoubleDouble());
  EXPECT_EQ(to_double(pair.shift), (Vec3d{3, 0, -10}));
  EXPECT_FALSE(pair.touch.touching);
  EXPECT_EQ(pair.touch_within, gas.touch_tolerance());
  EXPECT_EQ(Gas::start_of(gas.records[0], gas.records[1]), (Time{7, 0.5}));
}

// Above a floor, to which needles come back from beyond the box.
TEST(MakePair, TouchesWithinWhatFarPlacesRound) {
  Gas gas = gas_of(2, {3, 4, 5});
  gas.box = {gas.box.edges(), {true, true, false}};
  gas.gravity = {0, 0, -1};
  gas.falls = true;
  const auto within = [&](double height) {
    gas.records[0].flight.r.z = height;
    return make_pair(gas, needle, gas.records[0], partner, gas.records[1], {}).touch_within;
  };
  EXPECT_EQ(within(4.9), gas.touch_tolerance());
  EXPECT_EQ(within(5 + 1024), gas.touch_tolerance() + 0x1p-34);
  EXPECT_EQ(within(-1024 - 5), gas.touch_tolerance() + 0x1p-34);
}

TEST(MakePair, ShiftsByWholeBoxesExactly) {
  Gas gas = gas_of(2, {10.1, 0.3, 7.7});
  const Shift shift{-3, 1000000007, 5};
  const kernels::Pair pair = make_pair(gas, needle, gas.records[0], partner, gas.records[1], shift);
  EXPECT_TRUE(Wide(pair.shift.x.hi) + pair.shift.x.lo == Wide(10.1) * -3);
  EXPECT_TRUE(Wide(pair.shift.y.hi) + pair.shift.y.lo == Wide(0.3) * 1000000007);
  EXPECT_TRUE(Wide(pair.shift.z.hi) + pair.shift.z.lo == Wide(7.7) * 5);
}

// A touch kept in an earlier record is out of date if the other record is later.
TEST(MakePair, TakesTouchesFromTheLaterRecordOnly) {
  Gas gas = gas_of(3, {4, 4, 4});
  Record &a = gas.records[0], &b = gas.records[1];
  const Shift shift{0, 1, -1};
  const kernels::Touch of_a{.touching = true, .collided = true, .side = 1, .gap = 0};
  const kernels::Touch of_b{.touching = true, .collided = false, .side = -1, .gap = -1e-15};
  const auto only_of_b = [&](const Shift& at) {
    b.touch_count = 0;
    gas.add_touch(partner, RecordedTouch::of(Id{0}, a.serial, at, of_b));
  };
  gas.add_touch(needle, RecordedTouch::of(Id{2}, 0, shift, of_b));
  gas.add_touch(needle, RecordedTouch::of(Id{1}, b.serial, shift, of_a));
  const auto touch = [&](const Shift& at) {
    return make_pair(gas, needle, a, partner, b, at).touch;
  };
  a.time = {3, 0};
  b.time = {2, 0};
  EXPECT_TRUE(touch(shift).collided);
  EXPECT_EQ(touch(shift).side, 1);
  EXPECT_FALSE(touch({}).touching) << "another image";
  EXPECT_FALSE(touch(-shift).touching) << "the opposite image";
  b.time = {3, 1e-9};
  EXPECT_FALSE(touch(shift).touching) << "the other record is later";
  only_of_b(-shift);
  EXPECT_EQ(touch(shift).gap, -1e-15);
  EXPECT_EQ(touch(shift).side, -1);
  only_of_b(shift);
  EXPECT_FALSE(touch(shift).touching) << "the shift is of the partner";
  // Of two records of one time, either may keep the touch.
  b.time = a.time;
  EXPECT_EQ(touch(shift).side, 1);
  a.touch_count = 0;
  EXPECT_FALSE(touch(shift).touching);
  only_of_b(-shift);
  EXPECT_EQ(touch(shift).side, -1);
  ++a.serial;
  EXPECT_FALSE(touch(shift).touching) << "renewed at the same time";
}

TEST(MakePair, FindsEachOfManyTouches) {
  Gas gas = gas_of(6, {4, 4, 4});
  const auto side_of = [](std::size_t other) { return other % 2 ? 1 : -1; };
  for (std::size_t other = 1; other < 6; ++other) {
    const kernels::Touch touch{.touching = true,
                               .collided = other == 1,
                               .side = side_of(other),
                               .gap = 1e-16 * static_cast<double>(other)};
    const auto id = static_cast<std::uint32_t>(other);
    gas.add_touch(needle, RecordedTouch::of(Id{id}, 0, {static_cast<int>(other), 0, -1}, touch));
  }
  EXPECT_EQ(gas.records[0].touch_count, 5);
  const Record copy = gas.records[0];
  const auto touch = [&](const Record& mine, std::size_t other, const Shift& shift) {
    return make_pair(gas, needle, mine, Needle(other), gas.records[other], shift).touch;
  };
  const auto expect_all = [&](const Record& mine) {
    for (std::size_t other = 1; other < 6; ++other) {
      const kernels::Touch found = touch(mine, other, {static_cast<int>(other), 0, -1});
      EXPECT_TRUE(found.touching) << other;
      EXPECT_EQ(found.side, side_of(other)) << other;
      EXPECT_EQ(found.collided, other == 1) << other;
      EXPECT_EQ(found.gap, 1e-16 * static_cast<double>(other)) << other;
      EXPECT_FALSE(touch(mine, other, {0, 0, -1}).touching) << "another image of " << other;
      // The same from the partner's side, whose record keeps no touch.
      EXPECT_EQ(make_pair(gas, Needle(other), gas.records[other], needle, mine,
                          {-static_cast<int>(other), 0, 1})
                    .touch.side,
                side_of(other));
    }
  };
  expect_all(gas.records[0]);
  // A new record keeps no touches; a copy of the one before, as an undo log keeps it, still does.
  renew_in_flight(gas, needle, {}, {1, 0, 0});
  for (std::size_t other = 1; other < 6; ++other) {
    EXPECT_FALSE(touch(gas.records[0], other, {static_cast<int>(other), 0, -1}).touching);
  }
  expect_all(copy);
  // After it is restored and renewed again, it has the touches added the second time.
  const kernels::Touch again{.touching = true, .collided = false, .side = 1, .gap = 3e-16};
  for (const std::uint32_t id : {1u, 2u, 3u}) {
    gas.add_touch(needle, RecordedTouch::of(Id{id}, 0, {}, again));
  }
  gas.records[0] = copy;
  expect_all(gas.records[0]);
  renew_in_flight(gas, needle, {}, {1, 0, 0});
  for (const std::uint32_t id : {4u, 5u}) {
    gas.add_touch(needle, RecordedTouch::of(Id{id}, 0, {}, again));
  }
  for (std::size_t other = 1; other < 6; ++other) {
    EXPECT_EQ(touch(gas.records[0], other, {}).touching, other > 3) << other;
  }
}

TEST(Species, OfUnitLengthAndMassHasTheBodyOfNeedlesWithoutATable) {
  for (const double k : {6.0, 2.0, 0.3, 1e-9, 1e9}) {
    const Species species{.length = 1, .mass = 1, .k = k};
    EXPECT_TRUE(is_unit(species));
    const Body body = body_of(species);
    EXPECT_EQ(body.half_length, 0.5);
    EXPECT_EQ(body.inverse_mass, 1);
    EXPECT_EQ(body.inverse_inertia, 2 * k);
    EXPECT_EQ(2 * body.half_length, 1);
  }
  EXPECT_FALSE(is_unit(Species{.length = 1, .mass = 2}));
  EXPECT_FALSE(is_unit(Species{.length = std::nextafter(1, 0), .mass = 1}));
}

TEST(Gas, KnowsTheBodiesOfItsSpecies) {
  Gas gas = gas_of(2, {9, 9, 9});
  EXPECT_EQ(gas.longest, 1);
  gas.set_composition(
      Composition({{.length = 0.5, .mass = 4, .k = 2}, {.length = 3, .mass = 0.25, .k = 6}}, {}));
  EXPECT_EQ(gas.longest, 3);
  gas.records[1].species = 1;
  const Body &first = gas.body(Needle(0)), &second = gas.body(Needle(1));
  EXPECT_EQ(first.half_length, 0.25);
  EXPECT_EQ(first.inverse_mass, 0.25);
  // I = m L^2 / (2 k)
  EXPECT_EQ(first.inverse_inertia, 4);
  EXPECT_EQ(first.inertia, 0.25);
  EXPECT_EQ(2 * second.half_length, 3);
  EXPECT_EQ(second.inverse_mass, 4);
  EXPECT_EQ(second.inverse_inertia, 12 / (0.25 * 9));
  EXPECT_EQ(first.length(), 0.5);
  EXPECT_EQ(first.mass, 4);
  EXPECT_EQ(second.length(), 3);
  // What needles depart from their flights adds to their reach, not to their width.
  gas.let_slide();
  EXPECT_EQ(gas.longest, 3 * (1 + 0x1p-4));
  EXPECT_EQ(gas.body(Needle(1)).reach(), 1.5 * (1 + 0x1p-4));
  EXPECT_EQ(gas.body(Needle(1)).radius, 0);
  EXPECT_EQ(gas.body(Needle(1)).extent(), 3);
}

// However few there are of each.
TEST(MeanFreeTime, OfEqualNeedlesDoesNotDependOnTheirSpecies) {
  constexpr double volume = 7, t_tr = 0.7, t_rot = 1.3;
  const double one = mean_free_time({.density = 5 / volume, .t_tr = t_tr, .t_rot = t_rot, .k = 3});
  for (const std::vector<std::uint64_t>& counts :
       {std::vector<std::uint64_t>{3, 2}, {4, 1}, {1, 1, 1, 1, 1}}) {
    std::vector<Species> species;
    species.reserve(counts.size());
    for (const std::uint64_t count : counts)
      species.push_back({.name = {}, .count = count, .k = 3});
    const std::vector<SpeciesTemperatures> at(counts.size(), {t_tr, t_rot});
    EXPECT_NEAR(mean_free_time(Composition(species, {}), volume, at), one, 1e-14 * one)
        << counts.size();
  }
}

// The engine's own integration, which does not depend on the libm, agrees with the theory.
TEST(MeanFreeTime, AgreesWithTheTheory) {
  Random random(seed);
  for (int n = 0; n < 50; ++n) {
    const double density = random.log_uniform(1e-3, 100);
    const double t_tr = n == 0 ? 0 : random.log_uniform(1e-10, 1);
    const double t_rot = n > 0 && random.coin() ? 0 : random.log_uniform(1e-10, 1),
                 k = random.uniform(2, 20);
    const double rate = theory::collision_rate(density, {.t_tr = t_tr, .t_rot = t_rot}, k);
    EXPECT_NEAR(mean_free_time({.density = density, .t_tr = t_tr, .t_rot = t_rot, .k = k}) * rate,
                1, 1e-6)
        << "T_tr " << t_tr << ", T_rot " << t_rot << ", k " << k << ", seed " << seed;
  }
  EXPECT_EQ(mean_free_time({.density = 1}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(mean_free_time({.density = 1, .t_tr = 0x1p-120, .t_rot = 0x1p-120}),
            0x1p60 * mean_free_time({.density = 1, .t_tr = 1, .t_rot = 1}));
}

}  // namespace
}  // namespace needlework
