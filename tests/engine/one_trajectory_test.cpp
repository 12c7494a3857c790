// A scene has one trajectory: with every search, every calendar and every instruction set, on
// several threads, and with every compiler and build, because its hash is stored here.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "kernels/isa.h"
#include "src/calendar/names.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

Scene cooling_scene() {
  Scene scene = test::inelastic(test::scene_of(200, 6, 7), 0.8, 1e-3, -0.5);
  return scene;
}

constexpr const char* hash = "58e495311d1f64abb0f5355932fa6e94";
constexpr double collisions_per_needle = 40;

std::string hash_of(const Scene& scene) {
  Simulation simulation(scene);
  simulation.advance(test::until_collisions(collisions_per_needle));
  return simulation.trajectory_hash();
}

constexpr const char* searches[] = {"all-pairs", "linked-lists", "linked-cells", "capsules"};

void expect_the_hash(const std::string& search, const std::string& calendar, kernels::Isa isa) {
  Scene scene = cooling_scene();
  scene.engine.search = search;
  scene.engine.queue = calendar;
  scene.engine.isa = kernels::name_of(isa);
  ASSERT_EQ(hash_of(scene), hash) << search << ", " << calendar << ", " << scene.engine.isa;
}

// Any two of a search, a calendar and an instruction set are together in one of the runs.
TEST(OneTrajectory, OfEverySearchCalendarAndInstructionSet) {
  const auto isas = kernels::available();
  const std::size_t sets = std::max(isas.size(), std::size(searches));
  std::size_t calendar_number = 0;
  for (const std::string& calendar : calendar_names()) {
    for (std::size_t n = 0; n < sets; ++n) {
      const char* search = searches[(n + calendar_number) % std::size(searches)];
      ASSERT_NO_FATAL_FAILURE(expect_the_hash(search, calendar, isas[n % isas.size()]));
    }
    ++calendar_number;
  }
}

TEST(OneTrajectory, OfAllOfSearchCalendarAndInstructionSet_long) {
  for (const char* search : searches) {
    for (const std::string& calendar : calendar_names()) {
      for (const kernels::Isa isa : kernels::available()) {
        ASSERT_NO_FATAL_FAILURE(expect_the_hash(search, calendar, isa));
      }
    }
  }
}

void expect_one_hash(std::string_view isa, std::initializer_list<int> numbers_of_threads) {
  Scene scene = cooling_scene();
  for (const char* search : {"linked-cells", "capsules"}) {
    for (const int threads : numbers_of_threads) {
      scene.engine.search = search;
      scene.engine.isa = isa;
      scene = test::on_threads(scene, threads);
      ASSERT_EQ(hash_of(scene), hash) << search << ", " << isa << ", " << threads;
    }
  }
}

TEST(OneTrajectory, OfThreads) { expect_one_hash("auto", {2}); }

TEST(OneTrajectory, OfThreadsOnEveryInstructionSet_long) {
  for (const kernels::Isa isa : kernels::available())
    expect_one_hash(kernels::name_of(isa), {2, 3, 4, 8});
}

// The requested kernels are in use: the wider the vectors, the fewer SIMD steps.
TEST(OneTrajectory, IsFollowedInFewerStepsByWiderVectors) {
  Scene scene = cooling_scene();
  std::uint64_t before = 0;
  for (const kernels::Isa isa : kernels::available()) {
    scene.engine.isa = kernels::name_of(isa);
    Simulation simulation(scene);
    simulation.advance(test::until_collisions(collisions_per_needle));
    const std::uint64_t steps = simulation.counters().bracket_steps;
    EXPECT_GT(steps, 0u);
    if (before > 0) {
      EXPECT_LT(static_cast<double>(steps), 0.9 * static_cast<double>(before));
    }
    before = steps;
    EXPECT_GT(simulation.counters().sorts, 0u);  // no bit depends on sorting either
    EXPECT_EQ(simulation.isa(), scene.engine.isa);
  }
}

}  // namespace
}  // namespace needlework
