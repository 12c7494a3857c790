// Scenes drawn at random, on one thread and on several: of any density and shape of box, filled or
// not, elastic, rough, cooling, sheared and sliding, with every kind of end.
// NEEDLEWORK_RANDOM_SCENES=N in the environment sets their number. Random scenes have found errors
// that no chosen one had.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "needlework/initial_state.h"
#include "tests/support/same_run.h"

namespace needlework {
namespace {

// Random numbers that are the same with every standard library.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
  }
  double power_of_ten(double low, double high) { return std::pow(10, uniform(low, high)); }
  bool one_in(double count) { return uniform(0, count) < 1; }
  template <class T>
  T of(std::initializer_list<T> values) {
    return values.begin()[bits_() % values.size()];
  }

 private:
  std::mt19937_64 bits_;
};

struct Drawn {
  Scene scene;
  Scene::Until until;
  double gathered = 1;  ///< fraction of each edge of the box in which needles start

  State state() const {
    State out = draw_initial_state(scene);
    for (auto& r : out.position) {
      for (double& x : r) x *= gathered;
    }
    return out;
  }
};

Drawn draw(std::uint64_t seed) {
  Draw draw(seed);
  Scene scene;
  scene.needles.count = draw.of({2u, 50u, 130u, 200u, 500u, 1000u, 3000u, 8000u});
  const auto count = static_cast<double>(scene.needles.count);
  const double least = 2.01;
  const double side = std::cbrt(count / draw.power_of_ten(-1.5, 1.5));
  const double longer = draw.one_in(4) ? draw.uniform(1, 20) : 1;
  scene.needles.box = {std::max(least, side * longer * longer), std::max(least, side / longer),
                       std::max(least, side / longer)};
  scene.needles.seed = seed;
  if (draw.one_in(5)) scene.needles.k = draw.of({2.0, 50.0});
  if (draw.one_in(3)) scene.initial.t_rot = draw.of({0.0, 0.1, 5.0});
  if (draw.one_in(2)) {
    scene.collisions.epsilon = draw.of({0.9, 0.5, 0.2});
    if (draw.one_in(3))
      scene.collisions.tc = 1e-4;
    else
      scene.collisions.tc_relative = draw.of({1e-3, 1e-5});
  }
  if (draw.one_in(3)) scene.collisions.beta = draw.uniform(-0.9, 0.9);
  const double most = 20000 / test::thin / std::max(count, 100.0);
  Scene::Until until = test::until_collisions(draw.uniform(0.01, most));
  if (draw.one_in(2)) until.time = draw.power_of_ten(-2, 1);
  if (scene.collisions.epsilon < 1 && draw.one_in(2)) until.energy_ratio = draw.uniform(0.3, 0.99);
  const double gathered = draw.one_in(4) ? draw.power_of_ten(-1, 0) : 1;
  if (gathered == 1 && draw.one_in(3)) {
    const double rate = draw.power_of_ten(-2, 1) * draw.of({-1.0, 1.0});
    scene.shear = Scene::Shear{.rate = rate, .offset = draw.uniform(0, scene.needles.box[0])};
  }
  return {scene, until, gathered};
}

// The end of a run, which must be the same on any number of threads.
struct End {
  Stop stop;
  std::uint64_t collisions;
  std::string hash;
  double time, energy;
  bool operator==(const End&) const = default;
};

void PrintTo(const End& end, std::ostream* out) {
  *out << "stop " << static_cast<int>(end.stop) << " after " << end.collisions << " collisions at "
       << end.time << ", energy " << end.energy << ", hash " << end.hash;
}

// `slice` is the wall time of one call; 0: the whole run in one call. Adds the counters of the run
// to `counters`.
End run(Drawn drawn, int threads, double slice, Counters& counters) {
  drawn.scene.engine.threads = threads;
  drawn.scene.engine.team = "all";
  if (slice > 0) drawn.until.wall_s = slice;
  Simulation simulation(drawn.scene, drawn.state());
  Stop stop;
  do {
    stop = simulation.advance(drawn.until);
  } while (stop == Stop::wall_time);
  counters += simulation.counters();
  const Totals totals = simulation.totals();
  return {stop, totals.collisions, simulation.trajectory_hash(), totals.time, totals.energy};
}

TEST(RandomScenes, EndAsOnOneThread_long) {
  const char* asked = std::getenv("NEEDLEWORK_RANDOM_SCENES");
  const int scenes = asked ? std::atoi(asked) : static_cast<int>(40 / test::thin);
  Counters counters;
  for (int seed = 1; seed <= scenes; ++seed) {
    const Drawn drawn = draw(static_cast<std::uint64_t>(seed));
    const int threads = std::array{2, 3, 2, 8}[static_cast<std::size_t>(seed % 4)];
    const End truth = run(drawn, 1, 0, counters);
    ASSERT_EQ(run(drawn, threads, seed % 3 ? 0 : 1e-3, counters), truth)
        << "seed " << seed << " on " << threads << " threads";
  }
  EXPECT_GT(counters.phases, 0u);
  if (test::thin == 1) {
    EXPECT_GT(counters.resized, 0u);
  }
}

}  // namespace
}  // namespace needlework
