// Tests the check that no event processed out of order could have affected an earlier one.
#include "src/engine/causality_log.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace needlework {
namespace {

TimeKey key_at(double time) { return std::bit_cast<TimeKey>(time); }

// A search of one needle.
LoggedEvent at(double time, const Vec3d& r, double speed) {
  return {key_at(time), r, speed, true, {0, time}};
}
// One needle of a contact.
LoggedEvent contact_at(double time, const Vec3d& r, double speed) {
  return {key_at(time), r, speed, false, {0, time}};
}

// Adds an event to the log, from now on without any before `hindmost`.
void add(CausalityLog& log, const LoggedEvent& event, TimeKey hindmost = 0) {
  log.add(event, log.cell_of(event.r), hindmost);
}

const Clock clock{1};
const std::array<double, 3> box{8, 9, 10};
const Vec3d here{4, 4, 4};
constexpr double far = 3;
constexpr double just = 1e-5;

// Whether a needle with an event may have met one with this other event. Gives the same result
// with both moved by fractions of the box.
bool may_have_met(const LoggedEvent& mine, double speed, const LoggedEvent& other) {
  std::optional<bool> out;
  for (const Vec3d& move : {Vec3d{0, 0, 0}, {3.9, 0, 0}, {0, 5.1, 0}, {0, 0, -3.8}, {-4, -4, -4}}) {
    CausalityLog log(CellGrid(box, 0.7, 1000), clock);
    LoggedEvent a = mine, b = other;
    a.r = a.r + move;
    b.r = b.r + move;
    add(log, b);
    const bool met = log.may_have_met(a, speed, far);
    EXPECT_EQ(met, out.value_or(met)) << "moved by " << move.x << ' ' << move.y << ' ' << move.z;
    out = met;
  }
  return *out;
}

// After an event at time 1, with speed 2; the other's is at 1.25, with speed 1 before: in a quarter
// they come nearer by 3/4, and touch within 1.
constexpr double reach = 1 + 0.25 * 3;

TEST(CausalityLog, KnowsHowFarNeedlesCanMeet) {
  EXPECT_NEAR(CausalityLog::reach(key_at(1), key_at(1.25), 3), reach, just);
  EXPECT_GT(CausalityLog::reach(key_at(1), key_at(1.25), 3), reach);
  // Includes a margin for rounding, also of the times.
  EXPECT_GT(CausalityLog::reach(key_at(1), key_at(1), 0), 1);
  EXPECT_GT(CausalityLog::reach(key_at(0x1p40), key_at(0x1p40), 0x1p20), 1 + 2 * 0x1p-53 * 0x1p60);
}

TEST(CausalityLog, FindsThoseThatMayHaveMet) {
  const LoggedEvent mine = at(1, here, 0);
  for (const Vec3d& way :
       {Vec3d{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0.6, 0, -0.8}, {0.48, 0.6, 0.64}}) {
    EXPECT_TRUE(may_have_met(mine, 2, at(1.25, here + (reach - just) * way, 1)));
    EXPECT_FALSE(may_have_met(mine, 2, at(1.25, here + (reach + just) * way, 1)));
    // Only the speeds of the first needle after its event, and of the other before its event,
    // count.
    EXPECT_FALSE(may_have_met(at(1, here, 9), 2, at(1.25, here + (reach + just) * way, 1)));
    EXPECT_FALSE(may_have_met(mine, 2 - 1e-3, at(1.25, here + (reach - just) * way, 1)));
    EXPECT_FALSE(may_have_met(mine, 2, at(1.25 - 1e-3, here + (reach - just) * way, 1)));
  }
}

TEST(CausalityLog, FindsAnImage) {
  CausalityLog log(CellGrid(box, 0.7, 1000), clock);
  add(log, at(2, {0.1, 8.9, 0.1}, 0));
  EXPECT_TRUE(log.may_have_met(at(1, {7.6, 0.4, 9.7}, 0), 0, far));   // 0.5, 0.5, 0.4
  EXPECT_FALSE(log.may_have_met(at(1, {7.4, 0.4, 9.5}, 0), 0, far));  // 0.7, 0.5, 0.6
  EXPECT_TRUE(log.may_have_met(at(1, {8.6, -0.6, 0.4}, 0), 0, far));  // not wrapped
}

TEST(CausalityLog, LooksAtLaterEventsOnly) {
  for (const double before : {0.5, 1 - 1e-12}) {
    EXPECT_FALSE(may_have_met(at(1, here, 0), 2, contact_at(before, here, 1)));
  }
  EXPECT_TRUE(may_have_met(at(1, here, 0), 2, at(1 + 1e-12, here, 1)));
}

// Entries are rounded, but none is missed for that: not in the largest boxes, and at any speed.
TEST(CausalityLog, RoundsOutwards) {
  for (const double length : {8.0, 0x1p12, 0x1p30}) {
    const std::array<double, 3> large{length, length, length};
    const CellGrid grid(large, length / 10, 1000);
    for (int n = 1; n < 200; ++n) {
      const double place = length * std::fmod(n * 0.618034, 1), way = 1 + 0.25 * n;
      CausalityLog log(grid, clock);
      add(log, at(1.25, {place + way * (1 - 0x1p-40), place, place}, n / 3.0));
      EXPECT_TRUE(log.may_have_met(at(1, {place, place, place}, 0), n - n / 3.0, 2 * way)) << n;
    }
  }
  for (const double unit : {1e-300, 1e-45, 1e-38, 1e38, 1e300}) {
    CausalityLog log(CellGrid(box, 0.7, 1000), clock);
    add(log, at(2 / unit, here + Vec3d{2 - just, 0, 0}, unit));
    EXPECT_TRUE(log.may_have_met(at(1 / unit, here, 0), 0, far)) << unit;
    EXPECT_FALSE(log.may_have_met(at(1 / unit, here - Vec3d{2 * just, 0, 0}, 0), 0, far)) << unit;
  }
}

// After many epochs two times may have one key.
TEST(CausalityLog, DistinguishesTimesOfOneKey) {
  const double time = 0x1p40 + 0.5;
  for (const auto& event : {at, contact_at}) {
    LoggedEvent early = event(time, here, 0), late = event(time, here, 0);
    early.time = {std::int64_t{1} << 40, 0.5};
    late.time = {std::int64_t{1} << 40, std::nextafter(0.5, 1)};
    EXPECT_TRUE(may_have_met(early, 1, late));
    EXPECT_FALSE(may_have_met(late, 1, early));
  }
}

TEST(CausalityLog, LooksAtAllLaterEvents) {
  CausalityLog log(CellGrid(box, 0.7, 1000), clock);
  add(log, at(1.25, here + Vec3d{0.1, 0, 0}, 0));
  add(log, at(0.5, here + Vec3d{0.1, 0, 0}, 0));  // does not hide the one before it
  EXPECT_TRUE(log.may_have_met(at(1, here, 0), 0, far));
  log.clear();
  EXPECT_FALSE(log.may_have_met(at(1, here, 0), 0, far));
  add(log, at(1, here, 0));
  EXPECT_FALSE(log.may_have_met(at(1, here, 0), 0, far));
  add(log, at(7, here + Vec3d{1, 1, 1}, 0.5));
  EXPECT_TRUE(log.may_have_met(at(1, here, 0), 0, far));
}

// What is before all events to come is forgotten, so that the log stays small. An event that comes
// nevertheless may have met what is forgotten.
TEST(CausalityLog, ForgetsWhatIsBeforeAllEventsToCome) {
  CausalityLog log(CellGrid(box, 0.7, 1000), clock);
  const Vec3d apart{far - just, 0, 0};  // farther than needles come in these times
  for (int n = 0; n < 1000; ++n) add(log, at(1 + n * 0.01, here, 0), key_at(1 + n * 0.01));
  EXPECT_LT(log.entries(), 10u);
  const double last = 1 + 999 * 0.01;
  EXPECT_FALSE(log.may_have_met(at(last - 1e-3, here + apart, 0), 0, far));
  EXPECT_TRUE(log.may_have_met(at(last - 1e-3, here, 0), 0, far));
  EXPECT_TRUE(log.may_have_met(at(2, here + apart, 0), 0, far));
  log.clear();
  EXPECT_FALSE(log.may_have_met(at(2, here, 0), 0, far));
  add(log, at(last, here, 0));
  EXPECT_FALSE(log.may_have_met(at(2, here + apart, 0), 0, far));
}

// Events at one time may be in either order, which matters unless each concerns one needle.
TEST(CausalityLog, TakesEventsAtOnceForLater) {
  const auto after = [](const LoggedEvent& other, const LoggedEvent& mine) {
    return may_have_met(mine, 1, other);
  };
  const LoggedEvent contact = contact_at(1, here, 1), search = at(1, here, 1);
  EXPECT_TRUE(after(contact, contact));
  EXPECT_TRUE(after(contact, search));
  EXPECT_TRUE(after(search, contact));
  EXPECT_FALSE(after(search, search));
  EXPECT_FALSE(after(contact_at(1, here + Vec3d{1 + just, 0, 0}, 1), contact));
}

// What a phase leaves does not count in the next, although it is not cleared.
TEST(CausalityLog, DoesNotCountWhatIsEarlier) {
  CausalityLog log(CellGrid(box, 0.7, 1000), clock);
  EXPECT_TRUE(log.is_before(key_at(0)));
  for (int n = 0; n < 100; ++n) add(log, contact_at(1 + n * 0.01, here, 1), key_at(1 + n * 0.01));
  EXPECT_FALSE(log.is_before(key_at(1 + 99 * 0.01)));
  EXPECT_TRUE(log.is_before(key_at(2)));
  EXPECT_FALSE(log.may_have_met(contact_at(2, here, 1), 1, far));
}

// `farthest` is a bound that the caller knows; a larger one gives the same result.
TEST(CausalityLog, SearchesToTheGivenDistance) {
  CausalityLog log(CellGrid(box, 0.7, 1000), clock);
  add(log, at(1.25, here + Vec3d{reach - just, 0, 0}, 1));
  EXPECT_TRUE(log.may_have_met(at(1, here, 0), 2, reach));
  EXPECT_TRUE(log.may_have_met(at(1, here, 0), 2, 100));
  EXPECT_FALSE(log.may_have_met(at(1, here, 0), 2, 0.1));
}

}  // namespace
}  // namespace needlework
