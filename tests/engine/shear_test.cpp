// Uniform shear: images that slide, against events in quad precision, other searches, symmetries
// and exact balances.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/box/box.h"
#include "tests/support/random.h"
#include "tests/support/runs.h"
#include "tests/support/same_run.h"

namespace needlework {
namespace {

using test::Followed;
using test::Recorded;
using test::scene_of;
using test::until_collisions;
using test::until_time;

// The rows of a file of numbers, by column.
std::map<std::string, std::vector<double>> table(const std::string& name) {
  std::ifstream file(std::string(NEEDLEWORK_SOURCE) + "/tests/engine/shear/" + name + ".csv");
  std::map<std::string, std::vector<double>> out;
  std::vector<std::string> names;
  std::string line, cell;
  for (bool head = true; std::getline(file, line); head = false) {
    std::istringstream cells(line);
    for (std::size_t n = 0; std::getline(cells, cell, ','); ++n) {
      if (head)
        names.push_back(cell);
      else
        out[names[n]].push_back(std::stod(cell));
    }
  }
  EXPECT_FALSE(out.empty()) << name;
  return out;
}

State state_of(const std::string& name, const std::array<double, 3>& box) {
  const auto columns = table(name);
  State out;
  out.box = box;
  for (std::size_t n = 0; n < columns.at("x").size(); ++n) {
    const auto vector = [&](const char* x, const char* y, const char* z) {
      return std::array{columns.at(x)[n], columns.at(y)[n], columns.at(z)[n]};
    };
    out.position.push_back(vector("x", "y", "z"));
    out.velocity.push_back(vector("vx", "vy", "vz"));
    out.orientation.push_back(vector("ux", "uy", "uz"));
    out.angular_velocity.push_back(vector("wx", "wy", "wz"));
  }
  return out;
}

Scene sheared(std::uint64_t count, double side, double rate, double offset = 0,
              std::uint64_t seed = 1) {
  Scene scene = scene_of(count, side, seed);
  scene.shear = Scene::Shear{rate, offset};
  scene.collisions.epsilon = 0.9;
  return scene;
}

Scene of_spheres(Scene scene) {
  scene.species = {{.name = "spheres",
                    .count = scene.needles.count,
                    .length = 0,
                    .mass = 1,
                    .k = 6,
                    .t_tr = 1,
                    .t_rot = 0,
                    .diameter = 1}};
  return scene;
}

Scene by(Scene scene, const char* search) {
  scene.engine.search = search;
  return scene;
}

// The lists were made by a program of its own in quad precision, which knows no box, only needles
// and their images. `sensitivity` is by how much a time changes when all initial numbers change by
// 1e-16.
void expect_events_of_quad(const Scene& scene, const std::string& name) {
  const State initial = state_of(name, scene.needles.box);
  const auto events = table(name + "_events");
  const std::vector<double>& times = events.at("time");
  for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
    Followed run(by(scene, search), initial);
    run.advance_to_collision(static_cast<double>(times.size()));
    std::size_t compared = 0;
    for (std::size_t n = 0; n < times.size(); ++n, ++compared) {
      const double sensitivity = events.at("sensitivity")[n];
      if (!(sensitivity < 1e-8)) break;
      const Collision& got = run.collisions[n];
      ASSERT_EQ(got.first, std::min(events.at("first")[n], events.at("second")[n])) << n;
      ASSERT_EQ(got.second, std::max(events.at("first")[n], events.at("second")[n])) << n;
      ASSERT_NEAR(got.time, times[n], 1e-15 * times[n] + 30 * sensitivity) << n << ' ' << search;
    }
    EXPECT_GT(compared, 100u);
  }
}

TEST(Shear, OfNeedlesHasTheEventsOfQuad) {
  Scene scene = sheared(30, 3, 1, 0.75);
  scene.needles.box = {3, 3.5, 2.5};
  expect_events_of_quad(scene, "needles");
}
TEST(Shear, OfSpheresHasTheEventsOfQuad) {
  expect_events_of_quad(of_spheres(sheared(24, 4, 1)), "spheres");
}

// Scenes of every body and rule that goes with shear.
Scene any_scene(test::Random& random) {
  const double side = random.uniform(2.2, 7);
  Scene scene =
      scene_of(static_cast<std::uint64_t>(20 + random.below(80)), side, random.below(1000));
  scene.needles.box = {side, random.uniform(2.2, 5), random.uniform(2.2, 4)};
  scene.shear = Scene::Shear{random.log_uniform(0.02, 20) * (random.below(2) ? 1 : -1),
                             random.below(2) ? random.uniform(0, side) : 0};
  scene.collisions.epsilon = random.uniform(0.6, 1);
  if (random.below(3) == 0) scene.collisions.beta = random.uniform(-1, 1);
  scene.collisions.tc_relative = 0.01;
  switch (random.below(4)) {
    case 0:
      scene.species = {{.name = "long", .count = 20, .length = 1, .mass = 1},
                       {.name = "short", .count = 30, .length = 0.4, .mass = 0.3}};
      break;
    case 1:
      scene.species = {
          {.name = "rods", .count = 12, .length = 1, .mass = 1, .diameter = 0.05},
          {.name = "spheres", .count = 20, .length = 0, .mass = 1, .t_rot = 0, .diameter = 0.3}};
      scene.collisions.beta = -1;
      break;
    default:
      break;
  }
  if (random.below(3) == 0) {
    scene.walls = {{.axis = "z", .side = "both"}};
    if (random.below(2))
      scene.walls.front().temperature = 1;
    else
      scene.walls.front().epsilon = 0.9;
    if (random.below(2)) scene.forces.gravity = {0, 0, -1};
  }
  if (random.below(4) == 0)
    scene.driving.kicks = Scene::Kicks{.every = 0.3, .translational = 0.5, .rotational = 0.5};
  if (random.below(4) == 0 && scene.forces.gravity[2] == 0)
    scene.driving.andersen = Scene::Andersen{.rate = 0.5, .temperature = 1};
  return scene;
}

TEST(Shear, HasOneTrajectoryByEverySearch) {
  test::Random random(1);
  for (int n = 0; n < 60 / test::thin; ++n) {
    const Scene scene = any_scene(random);
    SCOPED_TRACE(testing::Message() << "scene " << n << ", rate " << scene.shear->rate);
    const State initial = draw_initial_state(scene);
    const Recorded truth = test::record(by(scene, "all-pairs"), initial, 300);
    for (const char* search : {"linked-lists", "linked-cells", "capsules"}) {
      const Recorded fast = test::record(by(scene, search), initial, 300);
      ASSERT_NO_FATAL_FAILURE(expect_same(truth, fast)) << search;
    }
  }
}

// Rows that do not slide are no effect.
TEST(Shear, OfRateZeroIsNone) {
  for (const double beta : {-1.0, 0.3}) {
    Scene plain = scene_of(120, 4, 3);
    plain.collisions.epsilon = 0.9;
    plain.collisions.beta = beta;
    Scene still = plain;
    still.shear = Scene::Shear{};
    const State initial = draw_initial_state(plain);
    EXPECT_EQ(draw_initial_state(still).velocity, initial.velocity);
    for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"})
      expect_same(test::record(by(plain, search), initial, 2000),
                  test::record(by(still, search), initial, 2000));
  }
}

TEST(Shear, GoesOnFromACheckpoint) {
  for (const bool spheres : {false, true}) {
    Scene scene = sheared(30, 4, 1.5, 2.5);
    if (spheres) scene = of_spheres(scene);
    Scene other = scene;
    other.shear->rate = 1.4;
    test::expect_to_continue(scene, 2.3, 6, other);
    Simulation whole(scene), half(scene);
    whole.advance(until_time(6));
    half.advance(until_time(2.3));
    Simulation rest(scene, half.checkpoint());
    rest.advance(until_time(6));
    EXPECT_EQ(rest.stress()->viscosity, whole.stress()->viscosity);
    EXPECT_EQ(rest.stress()->viscosity_error, whole.stress()->viscosity_error);
    EXPECT_EQ(rest.energy_budget().shear, whole.energy_budget().shear);
    EXPECT_EQ(rest.energy_drift(), whole.energy_drift());
    EXPECT_EQ(rest.copy().image, whole.copy().image);
  }
}

// Momentum, energy, and what collisions do to the pressure tensor, at any time.
TEST(Shear, BalancesToRounding) {
  for (const int kind : {0, 1, 2}) {
    Scene scene = sheared(200, 5, kind == 1 ? -2 : 2, 1.2);
    if (kind == 2) scene = of_spheres(sheared(60, 5, 1, 0.7));
    if (kind == 1) scene.collisions.beta = 0.2;
    Simulation simulation(scene);
    const double rate = scene.shear->rate;
    const auto spin = [&](const State& state) {
      std::array<double, 3> out{};
      for (const auto& w : state.angular_velocity)
        for (std::size_t a = 0; a < 3; ++a) out[a] += w[a] / (2 * scene.needles.k);
      return out;
    };
    const double energy = simulation.totals().energy,
                 count = static_cast<double>(scene.needles.count);
    const std::array<double, 3> spin_before = spin(simulation.copy());
    for (int n = 1; n <= 30; ++n) {
      simulation.advance(until_time(0.1 * n));
      const Totals totals = simulation.totals();
      const EnergyBudget budget = simulation.energy_budget();
      const StressSums sums = *simulation.stress_sums();
      const auto &k = sums.kinetic, &c = sums.collisional;
      const double scale = 1e-13 * (n + totals.energy) * count;
      for (const double momentum : totals.momentum) EXPECT_NEAR(momentum, 0, scale);
      EXPECT_NEAR(count * *budget.shear, -rate * (k[0][1] + c[1][0]), 10 * scale);
      EXPECT_NEAR(totals.energy - energy, budget.pairs + *budget.shear, scale / count);
      EXPECT_LE(std::abs(simulation.energy_drift()), 1e-14 * n);
      const std::array<double, 3> now = spin(simulation.copy());
      if (kind == 2) {
        for (std::size_t a = 0; a < 3; ++a)
          for (std::size_t b = 0; b < a; ++b) EXPECT_NEAR(c[a][b], c[b][a], scale);
        continue;
      }
      if (kind == 0) {
        EXPECT_NEAR(c[0][0] + c[1][1] + c[2][2], 0, scale);
      }
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3, d = (a + 2) % 3;
        EXPECT_NEAR(c[b][d] - c[d][b], spin_before[a] - now[a], 10 * scale) << a;
      }
    }
    EXPECT_GT(simulation.collisions(), 300u);
  }
}

// The times of all events that change a velocity.
std::vector<double> times_of_changes(const Scene& scene, double end) {
  Simulation simulation(scene);
  std::vector<double> out;
  simulation.on_happening([&](const Happening& each) { out.push_back(each.event.time); });
  simulation.on_kick([&] { out.push_back(simulation.time()); });
  simulation.advance(until_time(end));
  return out;
}

// Between events the velocity beside the flow changes evenly, so that states between them say how
// far each needle goes, whatever the engine does in between.
TEST(Shear, FollowsNeedlesBesideTheFlow) {
  Scene driven = sheared(20, 4, 1, 0.7);
  driven.walls = {{.axis = "z", .side = "both", .temperature = 1}};
  driven.driving.andersen = Scene::Andersen{.rate = 0.5, .temperature = 1};
  driven.driving.kicks = Scene::Kicks{.every = 0.3, .translational = 0.5, .rotational = 0.5};
  for (Scene scene : {sheared(20, 3, 1.5, 2.5), of_spheres(sheared(20, 4, -2)), driven}) {
    EXPECT_TRUE(Simulation(scene).copy().peculiar_x.empty());
    scene.output.observables = {"displacement"};
    const double end = 5, rate = scene.shear->rate;
    const std::vector<double> changes = times_of_changes(scene, end);
    ASSERT_GT(changes.size(), 60u);
    Simulation simulation(scene);
    State before = simulation.copy();
    std::vector<double> way(before.size());
    EXPECT_EQ(before.peculiar_x, way);
    double then = 0;
    for (std::size_t n = 0; n < changes.size(); ++n) {
      const double change = changes[n];
      const double now = (change + (n + 1 < changes.size() ? changes[n + 1] : end)) / 2;
      simulation.advance(until_time(now));
      const State after = simulation.copy();
      for (std::size_t i = 0; i < way.size(); ++i) {
        const auto &c0 = before.peculiar_velocity[i], &c1 = after.peculiar_velocity[i];
        const double t0 = change - then, t1 = now - change;
        way[i] += c0[0] * t0 - rate * c0[1] * t0 * t0 / 2;
        way[i] += c1[0] * t1 + rate * c1[1] * t1 * t1 / 2;
        ASSERT_NEAR(after.peculiar_x[i], way[i], 1e-12 * (1 + double(n))) << n << ' ' << i;
      }
      before = after;
      then = now;
    }
  }
}

// As their momentum along x stays 0, so does the sum of their ways.
TEST(Shear, FollowsThemFromCheckpointsAndOnThreads) {
  Scene scene = sheared(2000, 8, 1.5, 2.5);
  scene.output.observables = {"time_correlation"};
  Simulation whole(scene), half(scene);
  half.advance(until_time(0.7));
  whole.advance(until_time(1.5));
  const std::vector<double> way = whole.copy().peculiar_x;
  Simulation rest(scene, half.checkpoint());
  rest.advance(until_time(1.5));
  EXPECT_EQ(rest.copy().peculiar_x, way);
  scene.engine.threads = 2;
  Simulation threads(scene);
  threads.advance(until_time(1.5));
  EXPECT_EQ(threads.copy().peculiar_x, way);
  double sum = 0, largest = 0;
  for (const double each : way) sum += each, largest = std::max(largest, std::abs(each));
  EXPECT_NEAR(sum, 0, 1e-10);
  EXPECT_GT(largest, 1);
  scene.output.observables.clear();
  EXPECT_THROW(Simulation(scene, half.checkpoint()), InputError);
}

// The first collisions of two runs are the same, but for what a map of the state rounds. Needles
// that collide fly apart exponentially, by a decade or more in ten collisions of these.
void expect_same_pairs(const std::vector<Collision>& a, const std::vector<Collision>& b,
                       std::size_t first) {
  ASSERT_GE(std::min(a.size(), b.size()), first);
  for (std::size_t n = 0; n < first; ++n) {
    ASSERT_EQ(std::pair(a[n].first, a[n].second), std::pair(b[n].first, b[n].second)) << n;
    ASSERT_NEAR(a[n].time, b[n].time, 1e-9) << n;
  }
}

TEST(Shear, DoesNotKnowWhereYBegins) {
  const Scene scene = sheared(40, 3.5, 1.3, 0.4);
  const State initial = draw_initial_state(scene);
  const Recorded truth = test::record(scene, initial, 60);
  for (const double by : {0.7, 2.9, -11.3}) {
    State moved = initial;
    for (std::size_t n = 0; n < moved.size(); ++n) {
      moved.position[n][1] += by;
      moved.velocity[n][0] += scene.shear->rate * by;
    }
    expect_same_pairs(truth.collisions, test::record(scene, moved, 60).collisions, 50);
  }
}

TEST(Shear, HasAMirrorImage) {
  const Scene scene = sheared(40, 3.5, 1.3, 0.4);
  Scene mirrored = scene;
  mirrored.shear = Scene::Shear{-1.3, 3.5 - 0.4};
  const State initial = draw_initial_state(scene);
  State image = initial;
  for (std::size_t n = 0; n < image.size(); ++n) {
    image.position[n][0] *= -1;
    image.velocity[n][0] *= -1;
    image.orientation[n][0] *= -1;
    image.angular_velocity[n][1] *= -1;
    image.angular_velocity[n][2] *= -1;
  }
  expect_same_pairs(test::record(scene, initial, 60).collisions,
                    test::record(mirrored, image, 60).collisions, 50);
}

TEST(Shear, OfElasticNeedlesRunsBackwards) {
  Scene scene = sheared(40, 3.5, 1.3, 0.4);
  scene.collisions.epsilon = 1;
  Followed forth(scene, draw_initial_state(scene));
  const double end = 0.7;
  forth->advance(until_time(end));
  State state = forth->copy();
  for (std::size_t n = 0; n < state.size(); ++n) {
    for (double& v : state.velocity[n]) v = -v;
    for (double& w : state.angular_velocity[n]) w = -w;
  }
  state.shear_rate = -1.3;
  Scene back = scene;
  back.shear = Scene::Shear{-1.3, std::fmod(0.4 + 1.3 * 3.5 * end, 3.5)};
  Followed there(back, state);
  there->advance(until_time(end));
  std::vector<Collision> expected;
  for (std::size_t n = forth.collisions.size(); n-- > 0;) {
    expected.push_back(forth.collisions[n]);
    expected.back().time = end - expected.back().time;
  }
  EXPECT_GT(expected.size(), 20u);
  expect_same_pairs(expected, there.collisions, expected.size());
}

// A state says in which flow it is, and how far rows have slid.
TEST(Shear, StartsFromAStateInAFlow) {
  const Scene scene = sheared(60, 4, 1.5, 2.5);
  Simulation first(scene);
  first.advance(until_time(1.7));
  const State state = first.copy();
  EXPECT_NEAR(state.slide, std::fmod(2.5 + 1.5 * 4 * 1.7, 4), 1e-12);
  EXPECT_EQ(state.shear_rate, 1.5);
  Scene silent = scene;
  silent.shear->offset = 0;
  const auto beside = [](const Simulation& simulation) {
    return simulation.copy().peculiar_velocity;
  };
  const auto expect_same_beside = [&](const Simulation& simulation) {
    const auto got = beside(simulation), expected = beside(first);
    for (std::size_t n = 0; n < got.size(); ++n)
      for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(got[n][a], expected[n][a], 1e-12);
  };
  const Simulation same(silent, state);
  EXPECT_EQ(same.copy().position, state.position);
  EXPECT_EQ(same.copy().velocity, state.velocity);
  EXPECT_EQ(same.copy().slide, state.slide);
  expect_same_beside(same);
  Scene faster = silent;
  faster.shear->rate = 2;
  expect_same_beside(Simulation(faster, state));
  State beside_flow = state;
  beside_flow.velocity.clear();
  expect_same_beside(Simulation(silent, beside_flow));
  EXPECT_THROW(Simulation(scene, state), InputError);  // which says another slide
  Scene without = scene;
  without.shear.reset();
  EXPECT_THROW(Simulation(without, state), InputError);
}

TEST(Shear, RefusesAStateWithMomentumAcrossTheFlow) {
  const Scene scene = sheared(40, 3.5, 1.3);
  State state = draw_initial_state(scene);
  state.velocity[3][1] += 0.01;
  EXPECT_THROW(Simulation(scene, state), InputError);
  // Which stays as it is where nothing flows, and which a thermostat ends.
  Scene still = scene, thermal = scene;
  still.shear->rate = 0;
  thermal.driving.andersen = {.rate = 1, .temperature = 1};
  EXPECT_NO_THROW(Simulation(still, state));
  EXPECT_NO_THROW(Simulation(thermal, state));
}

// Rows are of the images in the box, as copy() gives them, however far needles have gone.
TEST(Shear, TakesVelocitiesAsItGivesThem) {
  const Scene scene = sheared(60, 4, 0.7);
  Simulation simulation(scene);
  simulation.advance(until_time(1.3));
  const State before = simulation.copy();
  const bool any_has_crossed =
      std::ranges::any_of(before.image, [](const auto& image) { return image[1] != 0; });
  ASSERT_TRUE(any_has_crossed);
  const Totals totals = simulation.totals();
  simulation.set_velocities(before.velocity, before.angular_velocity);
  const State after = simulation.copy();
  for (std::size_t n = 0; n < before.size(); ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(after.velocity[n][axis], before.velocity[n][axis], 1e-14) << n;
      EXPECT_NEAR(after.peculiar_velocity[n][axis], before.peculiar_velocity[n][axis], 1e-14) << n;
    }
  }
  EXPECT_NEAR(simulation.totals().energy, totals.energy, 1e-13);

  auto upwards = before.velocity;
  for (auto& v : upwards) v[1] += 1;
  try {
    simulation.set_velocities(upwards, before.angular_velocity);
    FAIL() << "expected an error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("set_velocities: a total momentum of 60 along y"),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(simulation.copy().velocity, after.velocity);
}

// Velocities beside the flow are those that are drawn, have the temperatures and no momentum.
TEST(Shear, DrawsVelocitiesBesideTheFlow) {
  const Scene scene = sheared(500, 6, 40, 1);
  const Totals totals = Simulation(scene).totals();
  EXPECT_NEAR(totals.t_tr, 1, 1e-12);
  EXPECT_NEAR(totals.t_rot, 1, 1e-12);
  for (const double momentum : totals.momentum) EXPECT_NEAR(momentum, 0, 1e-10);
}

// Where rods are placed, images have slid as well.
TEST(Shear, PlacesRodsBesideImagesThatHaveSlid) {
  for (const char* packing : {"insertion", "lattice"}) {
    for (const double offset : {0.0, 1.3, 5.1}) {
      Scene scene = of_spheres(sheared(150, 6.4, 1, offset));
      scene.initial.packing = packing;
      Simulation simulation(scene);
      simulation.advance(until_collisions(20));
      EXPECT_GT(simulation.totals().t_tr, 0);
    }
  }
}

}  // namespace
}  // namespace needlework
