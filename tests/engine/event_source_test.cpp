// An effect that lives in this test alone: a source of events with a column and a report, which the
// engine takes without a change of any of its files.
#include "src/effects/event_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "src/engine/run.h"
#include "tests/support/parallel_loops.h"
#include "tests/support/real.h"
#include "tests/support/runs.h"
#include "tests/support/trajectories.h"

namespace needlework {
namespace {

// Counts the half turns of each needle since it last collided or was counted, and strikes a needle
// that has made `most` of them since its last collision: its rotation is reversed.
class HalfTurns final : public EventSource {
 public:
  HalfTurns(Gas& gas, std::uint32_t most)
      : since_(gas.columns.add<std::uint32_t>("half turns of a record", 0)),
        serial_(gas.columns.add<std::uint32_t>("record", 0)),
        all_(gas.columns.add<std::uint64_t>("half turns", 0)),
        most_(most) {}

  const char* name() const override { return "half turns"; }
  std::size_t objects() const override { return 3; }
  SourceEvent next(const Gas& gas, Needle i, Time now, Time until) const override {
    const Record& record = gas.records[i];
    if (record.flight.omega == 0) return {};
    const double turn = std::numbers::pi / record.flight.omega;
    const Time time = std::max(now, gas.clock.add(record.time, turn * (1 + counted(record, i))));
    return time > until ? SourceEvent{} : SourceEvent{time, 1};
  }
  SourceOutcome happen(const Gas& gas, const NeedleAt& at, std::int8_t) override {
    const Record& record = gas.records[at.needle];
    const std::uint32_t turns = counted(record, at.needle) + 1;
    since_[at.needle] = turns;
    serial_[at.needle] = record.serial;
    ++all_[at.needle];
    SourceOutcome out;
    out.object = std::min(turns, 2u);
    out.impulse = at.velocity;  // of some size, so that sums of it can be compared
    if (turns < most_) return out;
    out.changes_motion = true;
    out.velocity = at.velocity;
    out.angular_velocity = at.angular_velocity * -1;
    return out;
  }
  std::uint64_t all(Needle i) const { return all_[i]; }

 private:
  std::uint32_t counted(const Record& record, Needle i) const {
    return serial_[i] == record.serial ? since_[i] : 0;
  }

  Column<std::uint32_t>&since_, &serial_;
  Column<std::uint64_t>& all_;
  const std::uint32_t most_;
};

constexpr std::uint32_t never = ~std::uint32_t{0};

Scene gas(std::uint64_t count = 150, double side = 6) {
  Scene scene = test::scene_of(count, side, 4);
  scene.initial.t_rot = 3;
  return scene;
}

struct Turned {
  std::string hash;
  std::map<std::uint32_t, std::uint64_t> turns;  // by id
  std::uint64_t events = 0, redone = 0;
  std::vector<Happening> happenings;
  std::vector<ObjectTotals> objects;
};

// Makes the loop by `make(run)`.
template <class Make>
Turned turned(const Scene& scene, std::uint32_t most, const Make& make,
              const Scene::Until& until = test::until_collisions(6)) {
  needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
  auto owned = std::make_unique<HalfTurns>(run.gas, most);
  const HalfTurns& source = *owned;
  run.add_source(std::move(owned));
  Turned out;
  run.listeners.happening = [&](const Happening& h) { out.happenings.push_back(h); };
  const auto loop = make(run);
  EXPECT_EQ(loop->advance(StopConditions(run, until)), until.time ? Stop::time : Stop::collisions);
  out.hash = run.tally.hash.hex();
  out.redone = run.tally.counters.redone;
  if (!run.tally.by_source.empty()) out.events = run.tally.by_source[0].events;
  for (const ObjectTally& object : run.tally.by_object) {
    out.objects.push_back({object.events, object.impulse.value()});
  }
  for (Needle i{0}; i < run.gas.size(); ++i) out.turns[run.gas.ids[i].value] = source.all(i);
  return out;
}

// One that only looks on leaves every bit of the trajectory as it is.
TEST(SourceOfEvents, ThatChangesNothingChangesNoBit) {
  const Scene scene = gas();
  Simulation plain(scene);
  plain.advance(test::until_collisions(6));
  for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
    const Turned seen = turned(scene, never, test::loop_of(search, "tournament"));
    EXPECT_EQ(seen.hash, plain.trajectory_hash()) << search;
    EXPECT_GT(seen.events, 100u);
  }
}

// Its events are those that the angular velocities between collisions imply.
TEST(SourceOfEvents, HasAllItsEvents) {
  const Scene scene = gas();
  const State start = draw_initial_state(scene);
  const Turned seen =
      turned(scene, never, test::loop_of("capsules", "bucket"), test::until_time(3));
  // By the reports of collisions: time and angular velocity from which each needle turns on.
  std::vector<double> since(start.size()), omega;
  std::vector<std::uint64_t> turns(start.size());
  for (const auto& w : start.angular_velocity) omega.push_back(std::hypot(w[0], w[1], w[2]));
  const auto fly = [&](std::uint32_t id, double until) {
    turns[id] += static_cast<std::uint64_t>(omega[id] * (until - since[id]) / std::numbers::pi);
    since[id] = until;
  };
  std::uint64_t events = 0;
  for (const Happening& h : seen.happenings) {
    if (!h.is_collision()) {
      EXPECT_EQ(h.kind, Happening::other);
      EXPECT_EQ(h.source, 1);
      EXPECT_FALSE(h.has_two_needles());
      ++events;
      continue;
    }
    for (const auto& [id, after] : {std::pair(h.event.first, h.event.after[0]),
                                    std::pair(h.event.second, h.event.after[1])}) {
      fly(id, h.event.time);
      const auto& w = after.angular_velocity;
      omega[id] = std::hypot(w[0], w[1], w[2]);
    }
  }
  for (std::uint32_t id = 0; id < start.size(); ++id) {
    fly(id, 3);
    EXPECT_EQ(seen.turns.at(id), turns[id]) << "needle " << id;
  }
  EXPECT_EQ(events, seen.events);
  EXPECT_GT(events, 300u);
}

// Counts of each object, and sums of impulses to the last bit, are those of the reports.
TEST(SourceOfEvents, CountsAtItsObjects) {
  const Turned seen = turned(gas(), 4, test::loop_of("capsules", "bucket"));
  std::vector<std::uint64_t> events(3);
  std::vector<test::Wide> impulses(3);
  for (const Happening& h : seen.happenings) {
    if (h.is_collision()) continue;
    ++events[h.event.second];
    const auto& j = h.event.impulse;
    impulses[h.event.second] += std::sqrt(j[0] * j[0] + j[1] * j[1] + j[2] * j[2]);
  }
  ASSERT_EQ(seen.objects.size(), 3u);
  EXPECT_EQ(events[0], 0u);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(seen.objects[n].events, events[n]);
    EXPECT_EQ(seen.objects[n].impulse, static_cast<double>(impulses[n]));
    if (n > 0) {
      EXPECT_GT(events[n], 100u);
    }
  }
}

TEST(SourceOfEvents, HasOneTrajectory) {
  const Scene scene = gas();
  const Turned first = turned(scene, 2, test::loop_of("all-pairs", "lazy-heap"));
  Simulation plain(scene);
  plain.advance(test::until_collisions(6));
  EXPECT_NE(first.hash, plain.trajectory_hash());
  for (const char* search : {"linked-lists", "linked-cells", "capsules"}) {
    for (const char* calendar :
         {"lazy-heap", "indexed-heap", "tournament", "bucket", "cell-calendar"}) {
      const Turned other = turned(scene, 2, test::loop_of(search, calendar));
      EXPECT_EQ(other.hash, first.hash) << search << ", " << calendar;
      EXPECT_EQ(other.turns, first.turns) << search << ", " << calendar;
    }
  }
}

// With short sight phases are rolled back again and again, columns too.
TEST(SourceOfEvents, HasOneTrajectoryOnThreads_long) {
  const Scene scene = gas(1200, 12);
  for (const std::uint32_t most : {never, 2u}) {
    const Turned first = turned(scene, most, test::loop_of("linked-cells", "tournament"));
    for (const char* search : {"linked-cells", "capsules"}) {
      for (const double sight : {1.6, 0.3}) {
        const Turned other = turned(scene, most, [&](needlework::Run& run) {
          return test::parallel_loop(run, search, 3,
                                     {.sight = sight, .least = 1, .by_cost = false});
        });
        if (sight < 1) {
          EXPECT_GT(other.redone, 0u);
        }
        EXPECT_EQ(other.hash, first.hash) << search << ", sight " << sight;
        EXPECT_EQ(other.turns, first.turns) << search << ", sight " << sight;
        EXPECT_EQ(other.events, first.events);
        ASSERT_EQ(other.objects.size(), first.objects.size());
        for (std::size_t n = 0; n < first.objects.size(); ++n) {
          EXPECT_EQ(other.objects[n].events, first.objects[n].events) << n;
          EXPECT_EQ(other.objects[n].impulse, first.objects[n].impulse) << n;
        }
        ASSERT_EQ(other.happenings.size(), first.happenings.size());
        for (std::size_t n = 0; n < first.happenings.size(); ++n) {
          ASSERT_EQ(other.happenings[n].kind, first.happenings[n].kind) << n;
          ASSERT_EQ(other.happenings[n].event.time, first.happenings[n].event.time) << n;
        }
      }
    }
  }
}

}  // namespace
}  // namespace needlework
