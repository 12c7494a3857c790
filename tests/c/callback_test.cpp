// The callback of a C program is given every collision, once and in order.
#include <omp.h>

#include <algorithm>
#include <thread>

#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::Arrays;
using test::cooling;
using test::CSimulation;

/// What a callback has seen.
struct Seen {
  std::vector<needlework_collision> collisions;
  std::vector<std::size_t> sizes;
  std::size_t refused_from = ~std::size_t{0};  ///< number of calls after which it says stop
  std::thread::id thread;

  static int add(const needlework_collision* first, std::size_t count, void* user) {
    Seen& seen = *static_cast<Seen*>(user);
    seen.collisions.insert(seen.collisions.end(), first, first + count);
    seen.sizes.push_back(count);
    seen.thread = std::this_thread::get_id();
    return seen.sizes.size() >= seen.refused_from;
  }
  std::vector<double> times() const {
    std::vector<double> out;
    for (const needlework_collision& collision : collisions) out.push_back(collision.time);
    return out;
  }
};

TEST(CCallback, IsGivenEveryCollisionOnceInOrder) {
  std::vector<std::vector<double>> times;
  for (const std::size_t batch : {1, 7, 1000}) {
    const CSimulation simulation(cooling);
    Seen seen;
    EXPECT_EQ(needlework_set_callback(simulation, batch, Seen::add, &seen), NEEDLEWORK_OK);
    simulation.run_to(30);
    simulation.run_to(100);
    ASSERT_EQ(seen.collisions.size(), 100u);
    times.push_back(seen.times());
    EXPECT_TRUE(std::is_sorted(times.back().begin(), times.back().end()));
    EXPECT_LE(*std::max_element(seen.sizes.begin(), seen.sizes.end()), batch);
    if (batch == 7) {
      EXPECT_EQ(seen.sizes,
                (std::vector<std::size_t>{7, 7, 7, 7, 2, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7}));
    }
  }
  EXPECT_EQ(times[0], times[1]);
  EXPECT_EQ(times[0], times[2]);
}

TEST(CCallback, DescribesTheCollision) {
  const CSimulation simulation(cooling);
  Seen seen;
  EXPECT_EQ(needlework_set_callback(simulation, 1, Seen::add, &seen), NEEDLEWORK_OK);
  const double energy = 60 * simulation.totals().energy;
  simulation.run_to(200);
  double change = 0;
  std::size_t elastic = 0;
  for (const needlework_collision& collision : seen.collisions) {
    change += collision.energy_change;
    elastic += collision.contact_time_rule;
    EXPECT_LT(collision.first, collision.second);
    EXPECT_LT(collision.second, 60u);
    EXPECT_LE(std::abs(collision.arm_first), 0.5);
    EXPECT_LE(std::abs(collision.arm_second), 0.5);
    EXPECT_NEAR(
        collision.time,
        static_cast<double>(collision.epoch) * simulation.totals().epoch_length + collision.offset,
        1e-12);
  }
  EXPECT_NEAR(60 * simulation.totals().energy, energy + change, 1e-10);
  EXPECT_EQ(elastic, simulation.totals().tc_collisions);
  // The last collision's needles still have the velocities from just after it.
  const needlework_collision& last = seen.collisions.back();
  const Arrays now(simulation);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(last.after[0].velocity[axis], now.velocity[3 * last.first + axis]);
    EXPECT_EQ(last.after[1].angular_velocity[axis], now.angular_velocity[3 * last.second + axis]);
  }
}

// In a gas without walls all that happens are collisions; one function does not replace the other.
TEST(CCallback, OfAllThatHappensIsGivenCollisionsToo) {
  const CSimulation simulation(cooling);
  Seen seen;
  std::vector<needlework_happening> happenings;
  const auto add = [](const needlework_happening* first, std::size_t count, void* user) {
    auto& all = *static_cast<std::vector<needlework_happening>*>(user);
    all.insert(all.end(), first, first + count);
    return 0;
  };
  EXPECT_EQ(needlework_set_callback(simulation, 7, Seen::add, &seen), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_set_happening_callback(simulation, 10, add, &happenings), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_set_happening_callback(simulation, 0, add, &happenings), NEEDLEWORK_USAGE);
  simulation.run_to(100);
  ASSERT_EQ(seen.collisions.size(), 100u);
  ASSERT_EQ(happenings.size(), 100u);
  for (std::size_t n = 0; n < 100; ++n) {
    EXPECT_EQ(happenings[n].kind, NEEDLEWORK_KIND_PAIR);
    EXPECT_EQ(happenings[n].source, 0);
    EXPECT_EQ(happenings[n].event.time, seen.collisions[n].time);
    EXPECT_EQ(happenings[n].event.after[1].velocity[2], seen.collisions[n].after[1].velocity[2]);
  }
  EXPECT_EQ(needlework_set_happening_callback(simulation, 0, nullptr, nullptr), NEEDLEWORK_OK);
  simulation.run_to(150);
  EXPECT_EQ(happenings.size(), 100u);
  EXPECT_EQ(seen.collisions.size(), 150u);
}

TEST(CCallback, StopsTheRunWithoutALoss) {
  for (const std::size_t batch : {1, 10}) {
    const CSimulation simulation(cooling), undisturbed(cooling);
    Seen seen, expected;
    seen.refused_from = 3;
    EXPECT_EQ(needlework_set_callback(simulation, batch, Seen::add, &seen), NEEDLEWORK_OK);
    EXPECT_EQ(needlework_set_callback(undisturbed, 1, Seen::add, &expected), NEEDLEWORK_OK);
    needlework_limits limits{};
    limits.collisions = 200;
    int stop = -1;
    EXPECT_EQ(needlework_run_until(simulation, &limits, &stop), NEEDLEWORK_OK);
    EXPECT_EQ(stop, NEEDLEWORK_STOP_INTERRUPTED);
    EXPECT_EQ(seen.collisions.size(), 3 * batch);
    EXPECT_LT(simulation.totals().collisions, 200u);
    seen.refused_from = ~std::size_t{0};
    simulation.run_to(200);
    undisturbed.run_to(200);
    EXPECT_EQ(seen.times(), expected.times());
    EXPECT_EQ(simulation.hash(), undisturbed.hash());
  }
}

TEST(CCallback, ThatRefusesTheRestStopsNoLaterRun) {
  const CSimulation simulation(cooling);
  Seen seen;
  seen.refused_from = 1;
  EXPECT_EQ(needlework_set_callback(simulation, 100, Seen::add, &seen), NEEDLEWORK_OK);
  needlework_limits limits{};
  limits.collisions = 20;
  int stop = -1;
  EXPECT_EQ(needlework_run_until(simulation, &limits, &stop), NEEDLEWORK_OK);
  EXPECT_EQ(stop, NEEDLEWORK_STOP_INTERRUPTED);
  seen.refused_from = ~std::size_t{0};
  simulation.run_to(40);
  EXPECT_EQ(seen.sizes, (std::vector<std::size_t>{20, 20}));
}

TEST(CCallback, IsTakenAwayByNull) {
  const CSimulation simulation(cooling);
  Seen seen;
  EXPECT_EQ(needlework_set_callback(simulation, 1, Seen::add, &seen), NEEDLEWORK_OK);
  simulation.run_to(5);
  EXPECT_EQ(needlework_set_callback(simulation, 0, nullptr, nullptr), NEEDLEWORK_OK);
  simulation.run_to(50);
  EXPECT_EQ(seen.collisions.size(), 5u);
}

TEST(CCallback, IsCalledByTheThreadThatRuns) {
  if (omp_get_thread_limit() < 2) GTEST_SKIP() << "OpenMP gives one thread only";
  const CSimulation simulation("needles = { count = 3000, box = 15 }\nengine.threads = 2\n");
  Seen seen;
  EXPECT_EQ(needlework_set_callback(simulation, 1, Seen::add, &seen), NEEDLEWORK_OK);
  simulation.run_to(3000);
  EXPECT_EQ(seen.thread, std::this_thread::get_id());
  EXPECT_EQ(seen.collisions.size(), 3000u);
  std::uint64_t phases = 0;
  EXPECT_EQ(needlework_get_counter(simulation, "phases", &phases), NEEDLEWORK_OK);
  EXPECT_GT(phases, 0u);
}

}  // namespace
}  // namespace needlework
