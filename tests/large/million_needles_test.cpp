// A million needles for some windows.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "needlework/theory.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

constexpr std::uint64_t count = 1000000;
constexpr double volume = count / 0.72;
// A window is half a mean free time to a whole one.
constexpr double collisions_per_needle = 4;

struct Seen {
  double energy_before, energy, rate;
  std::string hash;
  Counters counters;
};

template <class Callback>
Seen run(int threads, const Callback& on_collision) {
  Scene scene = test::scene_of(count, std::cbrt(volume), 11);
  scene.engine.threads = threads;
  Simulation simulation(scene);
  simulation.on_collision(on_collision);
  Seen seen{.energy_before = simulation.totals().energy};
  EXPECT_EQ(simulation.advance(test::until_collisions(collisions_per_needle)), Stop::collisions);
  const Totals totals = simulation.totals();
  seen.energy = totals.energy;
  seen.rate = 2 * static_cast<double>(totals.collisions) / count / totals.time;
  seen.hash = simulation.trajectory_hash();
  seen.counters = simulation.counters();
  return seen;
}

// Collisions of needles in groups by id, which has nothing to do with their places. The scatter of
// the groups gives the standard error of the rate. As a collision counts for both its needles,
// groups do not count independently: the sum scatters by sqrt(2) more than if they did.
class Groups {
 public:
  void add(const Collision& collision) {
    for (const std::uint32_t id : {collision.first, collision.second}) ++ends_[id % ends_.size()];
  }
  /// Of the number of collisions, relative.
  double error() const {
    test::Mean mean;
    for (const double ends : ends_) mean.add(ends);
    return std::sqrt(2) * mean.measured().error / mean.measured().value;
  }

 private:
  std::vector<double> ends_ = std::vector<double>(100);
};

TEST(MillionNeedles, KeepEnergyAndTheExactRateOnOneThreadAndTwo) {
  Groups groups;
  const Seen one = run(1, [&](const Collision& collision) { groups.add(collision); });
  EXPECT_NEAR(one.energy / one.energy_before, 1, 1e-12);
  const test::Measured rate{one.rate, one.rate * groups.error()};
  const double exact =
      theory::equilibrium_rate(count, volume, one.energy_before * static_cast<double>(count), 6);
  EXPECT_TRUE(test::agrees(rate, exact, 4));
  EXPECT_LT(groups.error(), 0.002);

  const Seen two = run(2, nullptr);
  EXPECT_EQ(two.hash, one.hash);
  EXPECT_EQ(two.energy, one.energy);
  EXPECT_GT(two.counters.phases, two.counters.redone);
}

}  // namespace
}  // namespace needlework
