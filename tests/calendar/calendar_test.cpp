// Every calendar against a sorted set on the same random operations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "src/calendar/all.h"
#include "src/calendar/any_calendar.h"
#include "src/calendar/names.h"
#include "tests/support/by_build.h"
#include "tests/support/random.h"

namespace needlework {
namespace {

using test::Random;

constexpr std::uint64_t seed = 1212;
constexpr int operations = test::by_build(50000, 5000);

/// The truth: all events in a balanced tree, ordered by time and then by owner's place in the order
/// of events.
class SortedReference {
 public:
  explicit SortedReference(std::size_t n) : events_(n) {
    for (std::size_t i = 0; i < n; ++i) {
      events_[i].owner = Needle(i);
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

// Needles are grouped into cells by index.
constexpr std::size_t in_cell = 16;
CellIndex cell_of(Needle i) { return static_cast<CellIndex>(i / in_cell); }

template <Calendar C>
C make_calendar_of(int n) {
  const auto size = static_cast<std::size_t>(n);
  return C(size, Clock(), (size + in_cell - 1) / in_cell);
}

bool equal_in_order(const Event& a, const Event& b) { return !(a < b) && !(b < a); }

/// Gives an event ids that are not indices, as after sorting needles in space.
Event named(Event event) {
  const auto id_of = [](Needle i) { return Id{i.index ^ 5u}; };
  const Id mine = id_of(event.owner);
  const Id other = event.is_contact() ? id_of(event.partner) : mine;
  event.owner_is_lower = mine <= other;
  event.lower_id = std::min(mine, other);
  event.higher_id = std::max(mine, other);
  return event;
}

Needle draw_needle(Random& random, int n) {
  return Needle(static_cast<std::size_t>(random.below(n)));
}

/// Times are drawn from few values when `ties`, so that equal ones are common.
Event draw_event(Random& random, int n, std::int64_t epoch, bool ties) {
  Event event;
  event.owner = draw_needle(random, n);
  if (random.below(20) == 0) return named(event);  // never
  event.time = ties ? Time{epoch + random.below(3), 0.25 * random.below(3)}
                    : Time{epoch + random.below(4), random.uniform()};
  if (n > 1 && random.below(3) > 0) {
    event.kind = EventKind::contact;
    do {
      event.partner = draw_needle(random, n);
    } while (event.partner == event.owner);
    event.shift = {random.below(3) - 1, random.below(2), 0};
  }
  return named(event);
}

template <Calendar C>
class CalendarTest : public testing::Test {};

using Calendars = AllCalendars<testing::Types>;

TYPED_TEST_SUITE(CalendarTest, Calendars);

template <Calendar C>
void expect_reference(int n, bool ties) {
  SCOPED_TRACE(std::to_string(n) + " needles, seed " + std::to_string(seed));
  Random random(seed + static_cast<std::uint64_t>(n) + ties);
  const auto size = static_cast<std::size_t>(n);
  C calendar = make_calendar_of<C>(n);
  SortedReference reference(size);
  std::vector<Event> last(size);
  for (Needle i{0}; i < size; ++i) last[i].owner = i;
  for (int step = 0; step < operations; ++step) {
    const Event event = draw_event(random, n, step / 50, ties);
    calendar.set(event, cell_of(event.owner));
    reference.set(event);
    last[event.owner] = event;
    ASSERT_TRUE(equal_in_order(calendar.top(), reference.top()))
        << "step " << step << ": top of needle " << calendar.top().owner << " instead of "
        << reference.top().owner;
    const Event& kept = calendar.of(event.owner);
    ASSERT_TRUE(kept.owner == event.owner && kept.partner == event.partner &&
                kept.kind == event.kind && kept.time == event.time && kept.shift == event.shift);
  }
  for (Needle i{0}; i < size; ++i) {
    ASSERT_EQ(calendar.of(i).time, last[i].time);
    ASSERT_EQ(calendar.of(i).partner, last[i].partner);
  }
}

TYPED_TEST(CalendarTest, HasTheEarliestEventOnTop) {
  for (const int n : {1, 2, 3, 5, 6, 21, 22, 64, 65, 513, 1000})
    expect_reference<TypeParam>(n, false);
}

TYPED_TEST(CalendarTest, SettlesEqualTimesByOrder) {
  for (const int n : {1, 2, 3, 17, 1000}) expect_reference<TypeParam>(n, true);
}

// The use of the event loop: the top is taken, and it and one other get later events. Calendar and
// reference are compared at each step.
template <Calendar C>
class Loop {
 public:
  explicit Loop(int n)
      : n_(n), calendar_(make_calendar_of<C>(n)), reference_(static_cast<std::size_t>(n)) {}

  Needle end() const { return Needle(static_cast<std::size_t>(n_)); }

  void schedule(Needle owner, double ahead) {
    Event event;
    event.owner = owner;
    event.time = clock_.add(now_, ahead);
    calendar_.set(named(event), cell_of(owner));
    reference_.set(named(event));
  }

  /// `ahead(owner)` is how far ahead a needle's next event is.
  template <class Ahead>
  void step(const Ahead& ahead) {
    const Event event = calendar_.top();
    ASSERT_TRUE(equal_in_order(event, reference_.top()))
        << "seed " << seed << ": needle " << event.owner << " instead of "
        << reference_.top().owner;
    ASSERT_GE(event.time, now_);
    now_ = event.time;
    schedule(event.owner, ahead(event.owner));
    const Needle other = draw_needle(random, n_);
    schedule(other, ahead(other));
  }

  Time now() const { return now_; }
  const C& calendar() const { return calendar_; }

  Random random{seed};

 private:
  const Clock clock_;
  int n_;
  C calendar_;
  SortedReference reference_;
  Time now_;
};

TYPED_TEST(CalendarTest, PopsInTimeOrder) {
  for (const int n : {1, 2, 1000, 100000}) {
    Loop<TypeParam> loop(n);
    const auto ahead = [&](Needle) { return loop.random.exponential(); };
    for (Needle i{0}; i < loop.end(); ++i) loop.schedule(i, ahead(i));
    for (int step = 0; step < operations; ++step) {
      ASSERT_NO_FATAL_FAILURE(loop.step(ahead)) << n << " needles, step " << step;
    }
    if (n <= 1000) {
      EXPECT_GT(loop.now().epoch, operations / 2000);
    }
  }
}

// A gas that cools: the time between its events grows by fifteen orders of magnitude.
TYPED_TEST(CalendarTest, FollowsAGrowingTimeScale) {
  constexpr int n = 500;
  Loop<TypeParam> loop(n);
  double scale = 1e-3;
  const auto ahead = [&](Needle) { return scale * loop.random.uniform(); };
  for (Needle i{0}; i < loop.end(); ++i) loop.schedule(i, ahead(i));
  const double growth = std::pow(1e15, 1.0 / operations);
  for (int step = 0; step < operations; ++step, scale *= growth) {
    ASSERT_NO_FATAL_FAILURE(loop.step(ahead)) << "step " << step;
  }
  EXPECT_GT(loop.now().epoch, std::int64_t{100000000});
}

// Both scales at once, and changes between them within one event.
TYPED_TEST(CalendarTest, FollowsSuddenChanges) {
  constexpr int n = 500;
  Loop<TypeParam> loop(n);
  const double scales[] = {1, 1e-12, 1e9, 1e-3, 1e12};
  int step = 0;
  const auto ahead = [&](Needle owner) {
    const double scale = scales[step / (operations / 10) % 5];
    return loop.random.uniform() * (owner % 10 == 0 ? 1e-6 * scale : scale);
  };
  for (Needle i{0}; i < loop.end(); ++i) loop.schedule(i, ahead(i));
  for (; step < operations; ++step) {
    ASSERT_NO_FATAL_FAILURE(loop.step(ahead)) << "step " << step;
  }
}

// As at the start of a gas on a lattice: all at one instant, and again and again.
TYPED_TEST(CalendarTest, TakesOneInstantByIds) {
  constexpr int n = 20000;
  TypeParam calendar = make_calendar_of<TypeParam>(n);
  const auto put = [&](Needle owner, std::int64_t epoch) {
    Event event;
    event.owner = owner;
    event.time = {epoch, 0.5};
    calendar.set(named(event), cell_of(owner));
  };
  constexpr Needle end(n);
  for (Needle i{0}; i < end; ++i) put(i, 0);
  for (std::int64_t epoch = 0; epoch < 3; ++epoch) {
    for (Needle i{0}; i < end; ++i) {
      const Event event = calendar.top();
      ASSERT_EQ(event.time.epoch, epoch);
      ASSERT_EQ(event.lower_id, Id{i.index});
      put(event.owner, epoch + 1);
    }
  }
}

TYPED_TEST(CalendarTest, LetsNeverComeAndGo) {
  constexpr int n = 300;
  Loop<TypeParam> loop(n);
  constexpr double never = std::numeric_limits<double>::infinity();
  for (const double share : {0.1, 0.9, 0.999, 1.0, 0.0, 0.999, 0.5}) {
    for (Needle i{0}; i < loop.end(); ++i) loop.schedule(i, loop.random.uniform());
    const auto ahead = [&](Needle) {
      return loop.random.uniform() < share ? never : loop.random.uniform();
    };
    for (int step = 0; step < operations / 20; ++step) {
      if (loop.calendar().top().time == Time::never()) break;
      ASSERT_NO_FATAL_FAILURE(loop.step(ahead)) << share << " never, step " << step;
    }
  }
}

// Entries of a calendar for n needles, replaced events included: calendars other than these two
// replace the event of a needle in place.
std::size_t entries_of(const LazyHeap& calendar, std::size_t) { return calendar.entries(); }
std::size_t entries_of(const BucketCalendar& calendar, std::size_t) { return calendar.entries(); }
template <Calendar C>
std::size_t entries_of(const C&, std::size_t n) {
  return n;
}

// A needle whose event is replaced again and again, as of one among many others, while no event is
// processed.
TYPED_TEST(CalendarTest, ForgetsReplacedEvents) {
  constexpr int n = 200;
  Loop<TypeParam> loop(n);
  for (Needle i{0}; i < loop.end(); ++i) loop.schedule(i, 10 + loop.random.uniform());
  for (int step = 0; step < operations; ++step) {
    const double ahead = loop.random.uniform(5, 10);
    loop.schedule(Needle(7), ahead);
    loop.schedule(Needle(8), 100 * ahead);
    ASSERT_LE(entries_of(loop.calendar(), n), 5 * n + 64);
  }
  ASSERT_NO_FATAL_FAILURE(loop.step([](Needle) { return 1.0; }));
}

TYPED_TEST(CalendarTest, StartsWithoutEvents) {
  const TypeParam calendar(3, Clock(), 1);
  EXPECT_FALSE(calendar.empty());
  EXPECT_EQ(calendar.top().time, Time::never());
  EXPECT_EQ(calendar.of(Needle(2)).owner, Needle(2));
  EXPECT_TRUE(TypeParam(0, Clock(), 1).empty());
}

// A calendar behaves the same behind the interface of all calendars.
TYPED_TEST(CalendarTest, IsMadeByItsName) {
  const std::unique_ptr<AnyCalendar> calendar = make_calendar(TypeParam::name);
  ASSERT_NE(dynamic_cast<CalendarOf<TypeParam>*>(calendar.get()), nullptr);
  EXPECT_STREQ(calendar->name(), TypeParam::name);
  Random random(seed);
  for (const int n : {50, 20, 200}) {  // each time from the beginning
    const auto size = static_cast<std::size_t>(n);
    calendar->reset(size, Clock(), (size + in_cell - 1) / in_cell);
    EXPECT_EQ(calendar->top().time, Time::never());
    TypeParam direct = make_calendar_of<TypeParam>(n);
    for (int step = 0; step < 1000; ++step) {
      const Event event = draw_event(random, n, step / 50, true);
      calendar->set(event, cell_of(event.owner));
      direct.set(event, cell_of(event.owner));
      ASSERT_TRUE(equal_in_order(calendar->top(), direct.top())) << n << ", step " << step;
      ASSERT_EQ(calendar->of(event.owner).time, event.time);
      ASSERT_EQ(calendar->likely_next(), direct.likely_next());
    }
  }
}

TEST(MakeCalendar, NamesTheKnownOnesForAnUnknownName) {
  try {
    make_calendar("guess");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    std::string all = "auto";
    for (const std::string& name : calendar_names()) all += ", " + name;
    EXPECT_EQ(std::string(error.what()), "engine.queue = \"guess\": expected one of " + all);
  }
}

TEST(Calendars, AreAllDescribed) {
  const auto text_of = [](const char* name) {
    std::ifstream file(std::string(NEEDLEWORK_SOURCE "/") + name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string scenes = text_of("docs/scenes.md"), readme = text_of("src/calendar/README.md");
  const std::size_t row = scenes.find("\n| `queue` ");
  ASSERT_NE(row, scenes.npos);
  const std::string choices = scenes.substr(row, scenes.find('\n', row + 1) - row);
  for (const std::string& name : calendar_names()) {
    EXPECT_NE(choices.find("`\"" + name + "\"`"), choices.npos) << name << " in scenes.md";
    EXPECT_NE(readme.find("\n| `" + name + "` "), readme.npos) << name << " in README.md";
  }
}

// Ids equal indices here.
Event contact(std::uint32_t owner, std::uint32_t partner, double time, Shift shift = {}) {
  Event event;
  event.kind = EventKind::contact;
  event.owner = Needle(owner);
  event.partner = Needle(partner);
  event.owner_is_lower = owner < partner;
  event.lower_id = Id{std::min(owner, partner)};
  event.higher_id = Id{std::max(owner, partner)};
  event.time = {0, time};
  event.shift = shift;
  return event;
}

Event horizon(std::uint32_t owner, double time) {
  Event event;
  event.owner = Needle(owner);
  event.lower_id = event.higher_id = Id{owner};
  event.time = {0, time};
  return event;
}

TEST(BucketCalendar, ChangesItsWidthOnlyAfterManyEvents) {
  constexpr int n = 2000;
  Loop<BucketCalendar> loop(n);
  double scale = 1;
  const auto ahead = [&](Needle) { return scale * loop.random.uniform(); };
  for (Needle i{0}; i < loop.end(); ++i) loop.schedule(i, ahead(i));
  const double growth = std::pow(1e15, 1.0 / operations);
  for (int step = 0; step < operations; ++step, scale *= growth) loop.step(ahead);
  EXPECT_GT(loop.calendar().restarts(), 0u);
  EXPECT_LT(loop.calendar().restarts() * n, 2u * (n + 2 * operations));
}

/// A CellCalendar that is divided at random, and what it must hold.
class DividedCalendar {
 public:
  static constexpr int n = 200;
  static constexpr std::uint32_t cells = 7, subdomains = 3;

  DividedCalendar() : calendar(n, Clock(), cells), events(n), cell(n, 0) {
    for (Needle i{0}; i < n; ++i) events[i].owner = i;
    divide();
  }
  void divide() {
    for (auto& z : subdomain) z = static_cast<std::uint32_t>(random.below(subdomains));
    for (auto& each : shown) each = random.below(2) == 0;
    calendar.divide(subdomain, subdomains, shown);
  }
  /// An event of a needle that one time in three has moved to another cell.
  Event draw(std::int64_t epoch, bool ties) {
    Event event = draw_event(random, n, epoch, ties);
    if (random.below(3) == 0) cell[event.owner] = static_cast<std::uint32_t>(random.below(cells));
    events[event.owner] = event;
    return event;
  }
  TimeKey key(Needle i) const { return calendar.key_of(events[i].time); }
  /// The earliest key of the needles for which chosen(needle).
  template <class Chosen>
  TimeKey earliest(Chosen&& chosen) const {
    TimeKey out = CellCalendar::no_event;
    for (Needle i{0}; i < n; ++i) {
      if (chosen(i)) out = std::min(out, key(i));
    }
    return out;
  }
  TimeKey earliest_in(std::uint32_t c) const {
    return earliest([&](Needle i) { return cell[i] == c; });
  }
  TimeKey earliest_of_subdomain(std::uint32_t z) const {
    return earliest([&](Needle i) { return subdomain[cell[i]] == z; });
  }
  const Event& first() const { return *std::min_element(events.begin(), events.end()); }

  CellCalendar calendar;
  std::vector<Event> events;
  std::vector<std::uint32_t> cell;  ///< of each needle
  std::vector<std::uint32_t> subdomain = std::vector<std::uint32_t>(cells);
  std::vector<std::uint8_t> shown = std::vector<std::uint8_t>(cells);
  Random random = Random(seed);
};

TEST(CellCalendar, KnowsTheEarliestOfSubdomainsAndShownCells) {
  DividedCalendar divided;
  const CellCalendar& calendar = divided.calendar;
  for (int step = 0; step < operations; ++step) {
    if (step % 1000 == 0) divided.divide();
    const Event event = divided.draw(step / 50, step % 2 == 0);
    divided.calendar.set(event, divided.cell[event.owner]);
    ASSERT_EQ(calendar.key_of(event.owner), divided.key(event.owner));
    ASSERT_EQ(calendar.cell_of(event.owner), divided.cell[event.owner]);
    for (std::uint32_t c = 0; c < divided.cells; ++c) {
      ASSERT_EQ(calendar.is_shown(c), divided.shown[c] != 0);
      ASSERT_EQ(calendar.published_key(c),
                divided.shown[c] ? divided.earliest_in(c) : CellCalendar::no_event)
          << "step " << step;
    }
    for (std::uint32_t z = 0; z < divided.subdomains; ++z) {
      ASSERT_EQ(calendar.winning_key(z), divided.earliest_of_subdomain(z)) << "step " << step;
    }
    ASSERT_TRUE(equal_in_order(calendar.top(), divided.first()))
        << "step " << step << ", seed " << seed;
  }
  const std::vector<std::size_t> counts = calendar.needles_in_cells();
  for (std::uint32_t c = 0; c < divided.cells; ++c) {
    EXPECT_EQ(counts[c], std::count(divided.cell.begin(), divided.cell.end(), c));
  }
}

// As threads use it: each step by itself, and without an order among equal keys.
TEST(CellCalendar, ChangesInSteps) {
  DividedCalendar divided;
  CellCalendar& calendar = divided.calendar;
  std::vector<CellIndex> changed;
  for (int step = 0; step < operations; ++step) {
    if (step % 1000 == 0) divided.divide();
    std::vector<TimeKey> published(divided.cells), won(divided.subdomains);
    for (std::uint32_t c = 0; c < divided.cells; ++c) published[c] = calendar.published_key(c);
    for (std::uint32_t z = 0; z < divided.subdomains; ++z) won[z] = calendar.winning_key(z);
    const Event event = divided.draw(step / 50, true);
    const Needle i = event.owner;
    const std::uint32_t before = calendar.subdomain_of(calendar.cell_of(i)),
                        now = calendar.subdomain_of(divided.cell[i]);
    changed.clear();
    calendar.put(event, divided.cell[i], changed);
    for (std::uint32_t c = 0; c < divided.cells; ++c) {
      ASSERT_EQ(calendar.published_key(c), published[c]) << "step " << step;
      if (!divided.shown[c]) continue;
      ASSERT_EQ(calendar.first_key(c), divided.earliest_in(c)) << "step " << step;
      if (calendar.first_key(c) != published[c]) {
        ASSERT_TRUE(std::find(changed.begin(), changed.end(), c) != changed.end());
      }
    }
    for (std::uint32_t z = 0; z < divided.subdomains; ++z) {
      ASSERT_EQ(calendar.winning_key(z), won[z]) << "step " << step;
    }
    if (step % 10 == 5) {
      calendar.order_again();  // makes up for the steps that are missing
    } else {
      for (const CellIndex c : changed) calendar.publish(c);
      if (before != now) calendar.follow(i, before, CellCalendar::no_event);
      calendar.follow(i, now, calendar.key_of(i));
    }
    for (std::uint32_t c = 0; c < divided.cells; ++c) {
      if (!divided.shown[c]) continue;
      ASSERT_EQ(calendar.published_key(c), divided.earliest_in(c));
    }
    for (std::uint32_t z = 0; z < divided.subdomains; ++z) {
      ASSERT_EQ(calendar.winning_key(z), divided.earliest_of_subdomain(z)) << "step " << step;
      if (calendar.winning_key(z) == CellCalendar::no_event) continue;
      ASSERT_EQ(calendar.key_of(calendar.winner(z)), calendar.winning_key(z));
    }
    if (step % 10 != 0) continue;
    calendar.order_again();
    ASSERT_TRUE(equal_in_order(calendar.top(), divided.first()))
        << "step " << step << ", seed " << seed;
  }
}

TEST(EventOrder, IsTimeThenHorizonsThenIdsThenShift) {
  EXPECT_LT(contact(5, 6, 0.25), horizon(0, 0.5));
  EXPECT_LT(horizon(9, 0.5), contact(0, 1, 0.5));
  EXPECT_LT(horizon(1, 0.5), horizon(2, 0.5));
  EXPECT_LT(contact(7, 1, 0.5), contact(2, 3, 0.5));
  EXPECT_LT(contact(3, 2, 0.5), contact(2, 4, 0.5));
  EXPECT_LT(contact(2, 3, 0.5, {-1, 0, 0}), contact(3, 2, 0.5, {0, -1, 0}));
  EXPECT_LT(horizon(4, 0.5), Event());
  EXPECT_LT(named(contact(4, 1, 0.5)), named(contact(0, 2, 0.5)));  // ids 1, 4 and 5, 7
}

TEST(EventOrder, TreatsTheCopiesOfOneContactAlike) {
  EXPECT_TRUE(equal_in_order(contact(2, 3, 0.5, {1, 0, 0}), contact(3, 2, 0.5, {1, 0, 0})));
  EXPECT_EQ(contact(3, 2, 0).lower(), Needle(2));
  EXPECT_EQ(contact(3, 2, 0).higher(), Needle(3));
  EXPECT_EQ(horizon(3, 0).lower(), Needle(3));
  EXPECT_FALSE(horizon(3, 0).is_contact());
}

}  // namespace
}  // namespace needlework
