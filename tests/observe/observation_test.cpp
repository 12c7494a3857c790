// Observables as a scene calls for them: by name, the same for every engine, absent when off.
#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>
#include <set>

#include "src/observe/cooling_theory.h"
#include "src/observe/forecast.h"
#include "src/observe/registry.h"
#include "tests/observe/observed.h"
#include "tests/support/scenes.h"

namespace needlework::observe {
namespace {

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const Entry& entry : registry()) names.emplace_back(entry.name);
  return names;
}

Scene cooling_scene() {
  Scene scene = test::inelastic(test::scene_of(600, 8), 0.8);
  scene.output.observables = all_names();
  return scene;
}

// The rows at some times of a run, bit by bit.
std::vector<std::uint64_t> rows_of(const Scene& scene, const State& initial) {
  Simulation simulation(scene, initial);
  Observation observation(scene);
  simulation.on_collision([&](const Collision& c) { observation.collision(c); });
  std::vector<std::uint64_t> bits;
  for (const double time : {0.0, 0.5, 1.0, 2.0, 4.0}) {
    simulation.advance(test::until_time(time));
    SpeciesSums sums;
    sums.walls = simulation.wall_totals();
    sums.energy = simulation.energy_budget();
    for (const double value : observation.sample(simulation.copy(), simulation.totals(), sums)) {
      bits.emplace_back();
      std::memcpy(&bits.back(), &value, sizeof value);
    }
  }
  EXPECT_GT(simulation.collisions(), 600u);
  return bits;
}

TEST(Observation, DoesNotDependOnThreadsAndStorage) {
  Scene scene = cooling_scene();
  const State initial = draw_initial_state(scene);
  const auto expected = rows_of(scene, initial);
  scene.engine.storage = "by-id";
  EXPECT_EQ(rows_of(scene, initial), expected);
  scene.engine.storage = "sorted";
  scene.engine.search = "capsules";
  for (const int threads : {1, 3}) {
    scene = test::on_threads(scene, threads);
    EXPECT_EQ(rows_of(scene, initial), expected) << threads << " threads";
  }
}

// The same between a wall of a temperature and one in motion, kicked.
TEST(Observation, OfWallsDoesNotDependOnThreads) {
  Scene scene = cooling_scene();
  scene.walls = {{.axis = "z", .side = "low"}, {.axis = "z", .side = "high", .temperature = 2}};
  scene.walls[0].motion = {.amplitude = 0.1, .frequency = 0.5, .phase = 0};
  scene.driving.kicks = {.every = 0.3, .translational = 1, .rotational = 1};
  const State initial = draw_initial_state(scene);
  const auto expected = rows_of(scene, initial);
  for (const int threads : {1, 3}) {
    scene.engine.search = "capsules";
    scene = test::on_threads(scene, threads);
    EXPECT_EQ(rows_of(scene, initial), expected) << threads << " threads";
  }
}

TEST(Observation, DoesNotDependOnTheOrderOfTheInitialState) {
  const Scene scene = cooling_scene();
  const State initial = draw_initial_state(scene);
  State turned = initial;
  turned.id.resize(turned.size());
  std::iota(turned.id.begin(), turned.id.end(), 0u);
  const auto reverse = [](auto& rows) { std::reverse(rows.begin(), rows.end()); };
  reverse(turned.id);
  reverse(turned.position);
  reverse(turned.velocity);
  reverse(turned.orientation);
  reverse(turned.angular_velocity);
  EXPECT_EQ(rows_of(scene, turned), rows_of(scene, initial));
}

TEST(Observation, HoldsWhatTheSceneNamesAndNothingElse) {
  Scene scene = cooling_scene();
  scene.output.observables = {"energy", "structure_factor", "flow_order", "flow_order"};
  std::vector<std::string> names;
  for (const SeriesGroup& group : Observation(scene).groups()) names.push_back(group.name);
  EXPECT_EQ(names, (std::vector<std::string>{"flow_order", "structure_factor"}));
  EXPECT_FALSE(Observation(scene).reads_collisions());

  scene.output.observables = {};
  Observation none(scene);
  EXPECT_TRUE(none.groups().empty());
  EXPECT_FALSE(none.reads_state());
  EXPECT_FALSE(none.reads_collisions());
  EXPECT_TRUE(none.sample({}, {}).empty());

  scene.output.observables = {"collision_statistics"};
  EXPECT_FALSE(Observation(scene).reads_state());
  EXPECT_TRUE(Observation(scene).reads_collisions());
}

TEST(Observation, OfNoneAndOneNeedleIsDefined) {
  for (const std::size_t count : {0u, 1u}) {
    Scene scene = cooling_scene();
    scene.needles.count = count;
    Observation observation(scene);
    EXPECT_NO_THROW(observation.sample(resting(count, scene.needles.box), {})) << count;
  }
}

TEST(Observation, NamesEachFieldOnceAndSaysWhatItMeans) {
  std::set<std::string> names;
  for (const SeriesGroup& group : Observation(cooling_scene()).groups()) {
    EXPECT_FALSE(group.meaning.empty());
    for (const SeriesField& field : group.fields) {
      EXPECT_TRUE(names.insert(group.name + "/" + field.name).second) << field.name;
      EXPECT_FALSE(field.meaning.empty() || field.meaning.ends_with('.')) << field.name;
    }
  }
}

TEST(CoolingTheory, IsTheCoolingCurveAtTheTimesOfTheSamples) {
  const theory::Gas gas{6, 0.8, -1};
  Observation observation(Scene{}, make_cooling_theory(gas, {1, 0}, 0.7));
  EXPECT_FALSE(observation.reads_state());
  for (const double time : {0.0, 0.01, 1.0, 2.0, 300.0, 1e7}) {
    Totals totals;
    totals.time = time;
    const auto row = observation.sample({}, totals);
    const std::vector tau{theory_time_scale(0.7) * time};
    const theory::Temperatures expected = theory::cooling_curve(gas, {1, 0}, tau).front();
    EXPECT_NEAR(row[0], expected.t_tr, 1e-10 * expected.t_tr) << time;
    EXPECT_NEAR(row[1], expected.t_rot, 1e-10 * expected.t_rot) << time;
    EXPECT_NEAR(row[2], expected.energy(), 1e-10 * expected.energy()) << time;
  }
}

// The names between backticks at the beginning of table rows.
std::vector<std::string> listed_names(const std::string& document) {
  std::ifstream file(NEEDLEWORK_SOURCE "/docs/" + document);
  EXPECT_TRUE(file) << document << " cannot be read";
  std::vector<std::string> names;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("| `/")) break;  // the table of datasets
    if (line.starts_with("| `")) names.push_back(line.substr(3, line.find('`', 3) - 3));
  }
  return names;
}

TEST(Registry, IsTheTableOfItsDocument) { EXPECT_EQ(listed_names("observables.md"), all_names()); }

TEST(Registry, IsWhatTheSceneReferenceOffers) {
  std::ifstream file(NEEDLEWORK_SOURCE "/docs/scenes.md");
  std::string line;
  while (std::getline(file, line) && !line.starts_with("| `observables` |")) {
  }
  std::string names;
  for (const std::string& name : all_names()) names += (names.empty() ? "`" : ", `") + name + "`";
  EXPECT_NE(line.find(names), std::string::npos) << line;
}

}  // namespace
}  // namespace needlework::observe
