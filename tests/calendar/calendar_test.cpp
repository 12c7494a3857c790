// Every calendar against a sorted set on the same random operations.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "src/calendar/indexed_heap.h"
#include "tests/support/random.h"

namespace needlework {
namespace {

using test::Random;

constexpr std::uint64_t seed = 1212;
#ifdef NDEBUG
constexpr int operations = 50000;
#else
constexpr int operations = 5000;
#endif

/// The truth: all events in a balanced tree, ordered by time and then by owner's place in the order
/// of events.
class SortedReference {
 public:
  explicit SortedReference(std::size_t n) : events_(n) {
    for (std::size_t i = 0; i < n; ++i) {
      events_[i].owner = static_cast<Needle>(i);
      sorted_.insert(events_[i]);
    }
  }
  const Event& top() const { return *sorted_.begin(); }
  void set(const Event& event) {
    const auto [first, last] = sorted_.equal_range(events_[event.owner]);
    for (auto it = first; it != last; ++it) {
      if (it->owner != event.owner) continue;
      sorted_.erase(it);
      break;
    }
    events_[event.owner] = event;
    sorted_.insert(event);
  }

 private:
  std::vector<Event> events_;
  std::multiset<Event> sorted_;
};

bool equal_in_order(const Event& a, const Event& b) { return !(a < b) && !(b < a); }

/// Times are drawn from few values when `ties`, so that equal ones are common.
Event draw_event(Random& random, Needle n, std::int64_t epoch, bool ties) {
  Event event;
  event.owner = static_cast<Needle>(random.below(static_cast<int>(n)));
  if (random.below(20) == 0) return event;  // never
  event.time = ties ? Time{epoch + random.below(3), 0.25 * random.below(3)}
                    : Time{epoch + random.below(4), random.uniform()};
  if (n > 1 && random.below(3) > 0) {
    do {
      event.partner = static_cast<Needle>(random.below(static_cast<int>(n)));
    } while (event.partner == event.owner);
    event.shift = {random.below(3) - 1, random.below(2), 0};
  }
  return event;
}

template <class Calendar>
class CalendarTest : public testing::Test {};

using Calendars = testing::Types<IndexedHeap>;

struct Names {
  template <class Calendar>
  static std::string GetName(int) {
    std::string name = Calendar::name;
    for (char& c : name) c = c == '-' ? '_' : c;
    return name;
  }
};
TYPED_TEST_SUITE(CalendarTest, Calendars, Names);

template <class Calendar>
void expect_reference(Needle n, bool ties) {
  SCOPED_TRACE(std::to_string(n) + " needles, seed " + std::to_string(seed));
  Random random(seed + n + ties);
  Calendar calendar(n);
  SortedReference reference(n);
  std::vector<Event> last(n);
  for (Needle i = 0; i < n; ++i) last[i].owner = i;
  for (int step = 0; step < operations; ++step) {
    const Event event = draw_event(random, n, step / 50, ties);
    calendar.set(event);
    reference.set(event);
    last[event.owner] = event;
    ASSERT_TRUE(equal_in_order(calendar.top(), reference.top()))
        << "step " << step << ": top of needle " << calendar.top().owner << " instead of "
        << reference.top().owner;
    const Event& kept = calendar.of(event.owner);
    ASSERT_TRUE(kept.owner == event.owner && kept.partner == event.partner &&
                kept.time == event.time && kept.shift == event.shift);
  }
  for (Needle i = 0; i < n; ++i) {
    ASSERT_EQ(calendar.of(i).time, last[i].time);
    ASSERT_EQ(calendar.of(i).partner, last[i].partner);
  }
}

TYPED_TEST(CalendarTest, HasTheEarliestEventOnTop) {
  for (const Needle n : {1, 2, 3, 5, 6, 21, 22, 1000}) expect_reference<TypeParam>(n, false);
}

TYPED_TEST(CalendarTest, SettlesEqualTimesByTheOrderOfEvents) {
  for (const Needle n : {1, 2, 3, 17, 1000}) expect_reference<TypeParam>(n, true);
}

// The use of the event loop: take the top, replace it and one other by later events.
TYPED_TEST(CalendarTest, PopsInTimeOrder) {
  Random random(seed);
  constexpr Needle n = 1000;
  TypeParam calendar(n);
  SortedReference reference(n);
  Clock clock;
  const auto schedule = [&](Needle owner, Time now) {
    Event event;
    event.owner = owner;
    event.time = clock.add(now, random.exponential());
    calendar.set(event);
    reference.set(event);
  };
  for (Needle i = 0; i < n; ++i) schedule(i, {});
  Time now;
  for (int step = 0; step < operations; ++step) {
    const Event event = calendar.top();
    ASSERT_EQ(event.owner, reference.top().owner) << "seed " << seed << ", step " << step;
    ASSERT_GE(event.time, now);
    now = event.time;
    schedule(event.owner, now);
    schedule(static_cast<Needle>(random.below(n)), now);
  }
  EXPECT_GT(now.epoch, operations / 2000);
}

TYPED_TEST(CalendarTest, StartsWithoutEvents) {
  const TypeParam calendar(3);
  EXPECT_FALSE(calendar.empty());
  EXPECT_EQ(calendar.top().time, Time::never());
  EXPECT_EQ(calendar.of(2).owner, 2u);
  EXPECT_TRUE(TypeParam(0).empty());
}

Event contact(Needle owner, Needle partner, double time, Shift shift = {}) {
  Event event;
  event.owner = owner;
  event.partner = partner;
  event.owner_is_lower = owner < partner;
  event.lower_id = std::min(owner, partner);
  event.higher_id = std::max(owner, partner);
  event.time = {0, time};
  event.shift = shift;
  return event;
}

Event horizon(Needle owner, double time) {
  Event event;
  event.owner = event.lower_id = event.higher_id = owner;
  event.time = {0, time};
  return event;
}

TEST(EventOrder, IsTimeThenHorizonsThenIdsThenShift) {
  EXPECT_LT(contact(5, 6, 0.25), horizon(0, 0.5));
  EXPECT_LT(horizon(9, 0.5), contact(0, 1, 0.5));
  EXPECT_LT(horizon(1, 0.5), horizon(2, 0.5));
  EXPECT_LT(contact(7, 1, 0.5), contact(2, 3, 0.5));
  EXPECT_LT(contact(3, 2, 0.5), contact(2, 4, 0.5));
  EXPECT_LT(contact(2, 3, 0.5, {-1, 0, 0}), contact(3, 2, 0.5, {0, -1, 0}));
  EXPECT_LT(horizon(4, 0.5), Event());
}

TEST(EventOrder, TreatsTheCopiesOfOneContactAlike) {
  EXPECT_TRUE(equal_in_order(contact(2, 3, 0.5, {1, 0, 0}), contact(3, 2, 0.5, {1, 0, 0})));
  EXPECT_EQ(contact(3, 2, 0).lower(), 2u);
  EXPECT_EQ(contact(3, 2, 0).higher(), 3u);
  EXPECT_EQ(horizon(3, 0).lower(), 3u);
  EXPECT_FALSE(horizon(3, 0).is_contact());
}

}  // namespace
}  // namespace needlework
