// Programs that use the library from threads of their own, or use OpenMP themselves.
#include <gtest/gtest.h>
#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <barrier>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "kernels/isa.h"
#include "needlework/error.h"
#include "tests/support/same_run.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

constexpr int steps = 8;
const double collisions_per_needle = 8 / std::sqrt(test::thin);

Scene scene_on(kernels::Isa isa, int threads, std::uint64_t seed) {
  Scene scene = test::inelastic(test::scene_of(1000, 8, seed), 0.9);
  scene.engine.isa = kernels::name_of(isa);
  scene = test::on_threads(scene, threads);
  return scene;
}

// Runs the scene and calls `between` after each of some steps.
template <class Between>
std::string hash_of(const Scene& scene, const Between& between) {
  Simulation simulation(scene);
  for (int step = 1; step <= steps; ++step) {
    simulation.advance(test::until_collisions(collisions_per_needle * step / steps));
    between();
  }
  EXPECT_EQ(simulation.isa(), scene.engine.isa);
  return simulation.trajectory_hash();
}

std::string hash_of(const Scene& scene) {
  return hash_of(scene, [] {});
}

// Two simulations run at once in two threads, which meet after each step, so that neither is done
// before the other begins.
TEST(HostThreads, RunSimulationsOnDifferentInstructionSets_long) {
  const std::vector<kernels::Isa> available = kernels::available();
  for (const int threads : {1, 2}) {
    for (const kernels::Isa isa : available) {
      const std::array scenes{scene_on(available.front(), threads, 1), scene_on(isa, threads, 2)};
      std::barrier meeting(2);
      std::array<std::string, 2> hashes;
      const auto run = [&](std::size_t n) {
        hashes[n] = hash_of(scenes[n], [&] { meeting.arrive_and_wait(); });
      };
      std::thread other(run, 1);
      run(0);
      other.join();
      for (const std::size_t n : {0, 1}) {
        EXPECT_EQ(hashes[n], hash_of(scenes[n])) << scenes[n].engine.isa << ", " << threads;
      }
    }
  }
}

// As Python's multiprocessing makes it: the child has none of OpenMP's threads.
TEST(HostProcess, MayForkAndGoOnInTheChild) {
  Scene scene = test::scene_of(6000, 14, 1);
  scene = test::on_threads(scene, 2);
  Simulation simulation(scene);
  Scene::Until until;
  until.time = simulation.mean_free_time() / std::sqrt(test::thin);
  simulation.advance(until);
  ASSERT_GT(simulation.counters().phases, simulation.counters().redone);
  *until.time *= 2;
  const pid_t child = fork();
  if (child == 0) {
    alarm(120);
    if (!(simulation.totals().energy > 0)) _exit(1);
    const auto phases = simulation.counters().phases;
    simulation.advance(until);
    if (simulation.counters().phases != phases) _exit(2);
    // Another one, from its beginning.
    Simulation again(scene);
    again.advance(until);
    if (again.trajectory_hash() != simulation.trajectory_hash()) _exit(3);
    _exit(again.collisions() > 0 ? 0 : 4);
  }
  int status = 1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

// OpenMP's settings of the thread that reads them.
struct Settings {
  int dynamic = omp_get_dynamic(), threads = omp_get_max_threads(),
      levels = omp_get_max_active_levels();
  omp_sched_t schedule{};
  int chunk = 0;

  Settings() { omp_get_schedule(&schedule, &chunk); }
  bool operator==(const Settings&) const = default;
};

void PrintTo(const Settings& settings, std::ostream* out) {
  *out << "dynamic " << settings.dynamic << ", threads " << settings.threads << ", levels "
       << settings.levels << ", schedule " << settings.schedule << ", chunk " << settings.chunk;
}

// A program with regions of its own. What a test sets is put back.
class HostWithOpenMP : public testing::Test {
 protected:
  ~HostWithOpenMP() override {
    omp_set_dynamic(before_.dynamic);
    omp_set_num_threads(before_.threads);
    omp_set_max_active_levels(before_.levels);
    omp_set_schedule(before_.schedule, before_.chunk);
  }

  // How many threads do something in a region that asks for this many.
  static int sum_of_ones(int threads) {
    int sum = 0;
#pragma omp parallel num_threads(threads) reduction(+ : sum)
    ++sum;
    return sum;
  }

  const Scene scene_ = scene_on(kernels::available().back(), 2, 3);
  const std::string truth_ = hash_of(scene_on(kernels::available().back(), 1, 3));

 private:
  const Settings before_;
};

TEST_F(HostWithOpenMP, GetsItsOwnNumbersOfThreads) {
  EXPECT_EQ(sum_of_ones(5), 5);
  EXPECT_EQ(hash_of(scene_, [] { EXPECT_EQ(sum_of_ones(3), 3); }), truth_);
  EXPECT_EQ(sum_of_ones(4), 4);
}

// With dynamic teams OpenMP may give fewer threads than asked for; a simulation may refuse that.
TEST_F(HostWithOpenMP, KeepsItsSettings) {
  for (const int dynamic : {0, 1}) {
    omp_set_dynamic(dynamic);
    omp_set_num_threads(3);
    omp_set_max_active_levels(2);
    omp_set_schedule(omp_sched_guided, 7);
    const Settings host;
    try {
      EXPECT_EQ(hash_of(scene_, [&] { EXPECT_EQ(Settings(), host); }), truth_);
    } catch (const InputError& error) {
      EXPECT_TRUE(dynamic) << error.what();
    }
    EXPECT_EQ(Settings(), host);
  }
}

TEST_F(HostWithOpenMP, RunsASimulationInEachThreadOfARegion) {
  omp_set_max_active_levels(2);
  for (const int threads : {1, 2}) {
    Scene scene = scene_;
    scene = test::on_threads(scene, threads);
    std::array<std::string, 3> hashes;
#pragma omp parallel num_threads(3)
    {
      const Settings host;
      hashes[static_cast<std::size_t>(omp_get_thread_num())] = hash_of(scene);
      EXPECT_EQ(Settings(), host);
    }
    for (const std::string& hash : hashes) EXPECT_EQ(hash, truth_) << threads << " threads";
  }
}

// Without nested regions each of those threads has no other to offer.
TEST_F(HostWithOpenMP, GetsAnErrorIfARegionLeavesOneThread) {
  omp_set_max_active_levels(1);
  std::array<std::string, 2> messages;
#pragma omp parallel num_threads(2)
  {
    std::string& message = messages[static_cast<std::size_t>(omp_get_thread_num())];
    try {
      message = hash_of(scene_);
    } catch (const InputError& error) {
      message = error.what();
    }
  }
  for (const std::string& message : messages) {
    EXPECT_NE(message.find("engine.threads = 2: expected at most 1"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace needlework
