// Observables of bodies that have numbers of their own, and of fixed ones; classes of size.
#include "src/composition/sizes.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "needlework/parse.h"
#include "src/observe/registry.h"
#include "tests/observe/observed.h"

namespace needlework::observe {
namespace {

const Vector room{4, 3, 3};
const std::vector<BodyNumbers> three_bodies{{1, 0, 1, 0.1}, {2, 0, 3, 0.3}, {0.5, 0, 2, 0.2}};

// A scene of one species with these bodies.
Scene of_bodies(const std::string& observable, const std::vector<BodyNumbers>& bodies) {
  Scene scene = scene_with(observable, bodies.size(), room, {2, 1, 1});
  SizesOfBodies sizes;
  for (const BodyNumbers& each : bodies) sizes.add(each);
  scene.species = {sizes.complete({.name = "a", .count = bodies.size()})};
  return scene;
}

State state_of(const std::vector<BodyNumbers>& bodies) {
  State state = resting(bodies.size(), room);
  for (const BodyNumbers& each : bodies) {
    state.own_bodies.length.push_back(each.length);
    state.own_bodies.diameter.push_back(each.diameter);
    state.own_bodies.mass.push_back(each.mass);
    state.own_bodies.inertia.push_back(each.inertia);
  }
  return state;
}

// Two in the half of low x, one in the other.
State three_that_differ() {
  State state = state_of(three_bodies);
  state.position = {{0.5, 1, 1}, {1.5, 2, 2}, {3, 1, 2}};
  state.velocity = {{1, 0, 0}, {3, 2, 0}, {0, -5, 0}};
  state.angular_velocity = {{4, 0, 0}, {0, 0, 0}, {1, 1, 0}};
  return state;
}

void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t n = 0; n < found.size(); ++n) EXPECT_NEAR(found[n], expected[n], 1e-12) << n;
}

TEST(OwnBodiesObserved, HaveFlowsByMass) {
  for (const char* name : {"fields", "profiles"}) {
    Values values = Observed(of_bodies(name, three_bodies)).sample(three_that_differ());
    // (1 (1, 0) + 3 (3, 2)) / 4, and what is left of the energies.
    const auto first = [&](const char* field, std::size_t count) {
      const std::vector<double>& all = values[field];
      return std::vector<double>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    };
    expect_near(first("flow", 6), {2.5, 1.5, 0, 0, -5, 0});
    expect_near(first("spin", 6), {1, 0, 0, 1, 1, 0});
    expect_near(first("thermal_tr", 2), {(4.5 + 3 * 0.5) / 4, 0});
    expect_near(first("thermal_rot", 2), {(0.1 * 9 + 0.3 * 1) / 4, 0});
  }
}

// Energies of the flow of each cell and of the motion relative to it add up to all.
TEST(OwnBodiesObserved, HaveAnOrderOfTheFlowByMass) {
  Values values = Observed(of_bodies("flow_order", three_bodies)).sample(three_that_differ());
  const double flow = 4 * (2.5 * 2.5 + 1.5 * 1.5) + 2 * 25, thermal = 4.5 + 3 * 0.5;
  expect_near(values["translational"], {flow / thermal});
  EXPECT_NEAR(flow + thermal, 1 * 1 + 3 * 13 + 2 * 25, 1e-12);
}

TEST(OwnBodiesObserved, HaveTemperaturesByTheirMasses) {
  Values values =
      Observed(of_bodies("temperature_by_axis", three_bodies)).sample(three_that_differ());
  expect_near(values["t_tr"], {(1 + 27) / 3.0, (12 + 50) / 3.0, 0});
  expect_near(values["t_rot"], {1.5 * 1.8 / 3, 1.5 * 0.2 / 3, 0});
}

TEST(OwnBodiesObserved, HaveEnergiesInHistograms) {
  Totals totals;
  totals.t_tr = totals.t_rot = 10;
  Values values =
      Observed(of_bodies("distributions", three_bodies)).sample(three_that_differ(), totals);
  std::vector<double> energies(150);
  for (const double energy : {0.5, 3 * 13 / 2.0, 25.0}) ++energies[std::size_t(energy / 10 * 10)];
  EXPECT_EQ(values["energy_tr"], energies);
  // sqrt(m / T) v along x: 1, 3 sqrt(3) and 0 over sqrt(10), in bins of 0.1 from -6 on.
  std::vector<double> along_x(120);
  for (const double v : {1.0, 3 * std::sqrt(3.0), 0.0})
    ++along_x[std::size_t((v / std::sqrt(10) + 6) * 10)];
  const std::vector<double>& found = values["velocity"];
  EXPECT_EQ(std::vector<double>(found.begin(), found.begin() + 120), along_x);
}

// With equal energies of all needles nothing departs but the fourth moments of single ones.
TEST(OwnBodiesObserved, HaveMomentsByTheirEnergies) {
  State state = state_of(three_bodies);
  for (std::size_t i = 0; i < 3; ++i) {
    state.velocity[i] = {1 / std::sqrt(three_bodies[i].mass), 0, 0};
    state.angular_velocity[i] = {0, 1 / std::sqrt(three_bodies[i].inertia), 0};
  }
  Values values = Observed(of_bodies("velocity_moments", three_bodies)).sample(state);
  expect_near(values["cumulant_v"], {0.6 - 1});
  expect_near(values["cumulant_w"], {0.5 - 1});
  expect_near(values["speeds"], {0});
  expect_near(values["velocity_spin"], {-0.5});
  expect_near(values["velocity_director"], {-0.5});
}

TEST(OwnBodiesObserved, HaveTheirMassesBetweenWalls) {
  Scene scene = of_bodies("wall_profiles", three_bodies);
  scene.walls = {{.axis = "x", .side = "both"}};
  Values values = Observed(scene).sample(three_that_differ());
  expect_near(values["flow"], {2.5, 0});
  expect_near(values["t_tr"], {(1 + 3 * 13) / 6.0, 2 * 25 / 3.0});
  expect_near(values["t_rot"], {0.1 * 16 / 4, 0.2 * 2 / 2});
  expect_near(values["t_normal"], {(1 + 27) / 2.0, 0});
  scene.output.observables = {"centre_of_mass"};
  values = Observed(scene).sample(three_that_differ());
  expect_near(values["position"], {(0.5 + 3 * 1.5 + 2 * 3) / 6});
  expect_near(values["velocity"], {(1 + 9) / 6.0});
}

// Fixed ones, whose mass a state has as infinite, neither weigh nor leave numbers undefined.
TEST(FixedBodiesObserved, LeaveTheNumbersOfOthersDefined) {
  Scene scene = parse_scene(
      "needles = { box = 6, seed = 2 }\nuntil.time = 1\n[[species]]\nname = \"a\"\ncount = 40\n"
      "length.distribution = \"uniform\"\nlength.mean = 1\nlength.width = 0.3\n"
      "mass.density = 2\n[[species]]\nname = \"still\"\ncount = 50\nfixed = true\n"
      "length.distribution = \"uniform\"\nlength.mean = 1\nlength.width = 0.3\n"
      "[[walls]]\naxis = \"x\"\nside = \"both\"\n",
      "fixed.toml");
  for (const Entry& entry : registry()) scene.output.observables.emplace_back(entry.name);
  scene.output.size_classes = 2;
  Simulation simulation(scene);
  const State start = simulation.copy();
  Observation observation(scene, nullptr, {start.id, start.species, start.own_bodies});
  simulation.on_collision([&](const Collision& c) { observation.collision(c); });
  SpeciesSums sums = no_sums(scene);
  std::span<const double> row;
  for (const double time : {0.0, 1.0}) {
    simulation.advance(test::until_time(time));
    sums.totals = simulation.species_totals();
    sums.collisions = simulation.collisions_by_pair();
    row = observation.sample(simulation.copy(), simulation.totals(), sums);
  }
  std::map<std::string, std::vector<double>> found;
  for (const SeriesGroup& group : observation.groups()) {
    for (const SeriesField& field : group.fields) {
      if (field.kind == SeriesField::Kind::constant) continue;
      const auto values = row.first(field.width());
      found[group.name + "/" + field.name] = {values.begin(), values.end()};
      row = row.subspan(field.width());
      for (const double value : values) EXPECT_FALSE(std::isinf(value)) << field.name;
    }
  }
  const SpeciesTotals& moving = sums.totals[0];
  const auto mean_of = [](const std::vector<double>& all, std::size_t begin, std::size_t end) {
    double out = 0;
    for (std::size_t n = begin; n < end; ++n) out += all[n] / static_cast<double>(end - begin);
    return out;
  };
  const std::vector<double>& by_axis = found["temperature_by_axis/t_tr"];
  EXPECT_NEAR(mean_of(by_axis, 0, 3), moving.t_tr, 1e-12);
  EXPECT_EQ(mean_of(by_axis, 3, 6), 0);
  EXPECT_NEAR(mean_of(found["temperature_by_axis/t_rot"], 0, 3), moving.t_rot, 1e-12);
  EXPECT_NEAR(mean_of(found["by_size/t_tr"], 0, 2), moving.t_tr, 1e-12);
  EXPECT_EQ(mean_of(found["by_size/t_tr"], 2, 4), 0);
  double energies = 0;
  for (std::size_t n = 0; n < 150; ++n) energies += found["distributions/energy_tr"][n];
  EXPECT_EQ(energies, 40);
  // The centre of mass is of those that move.
  EXPECT_EQ(found["centre_of_mass/position"][0], found["centre_of_mass/species_position"][0]);
  EXPECT_FALSE(std::isnan(found["centre_of_mass/species_position"][1]));
  EXPECT_EQ(found["centre_of_mass/species_velocity"][1], 0);
  // Each collision is one of a class of either species.
  const double hits = static_cast<double>(simulation.collisions());
  EXPECT_GT(hits, 5);
  double of_classes = 0;
  for (const double each : found["by_size/collisions"]) of_classes += each;
  EXPECT_EQ(of_classes, 2 * hits);
}

// Normal velocities count in the thermal ones of the two needles themselves.
TEST(OwnBodiesObserved, HaveNormalVelocitiesInTheirOwnUnits) {
  const Scene scene = of_bodies("collision_statistics", three_bodies);
  const State state = state_of(three_bodies);
  Observation observation(scene, nullptr, {state.id, {}, state.own_bodies});
  Totals totals;
  totals.t_tr = 2, totals.t_rot = 3;
  observation.sample(state, totals, {});
  Collision c{};
  c.first = 0, c.second = 1;
  c.arm_first = 0.2, c.arm_second = -0.9;
  c.after[0].orientation = {1, 0, 0}, c.after[1].orientation = {0, 1, 0};
  c.sin_angle = 1;
  const double sigma = std::sqrt(2 / 1.0 + 2 / 3.0 + 3 * 0.04 / 0.1 + 3 * 0.81 / 0.3);
  c.normal_velocity = 1.55 * sigma;
  observation.collision(c);
  const auto row = observation.sample(state, totals, {});
  std::size_t at = 0;
  for (const SeriesField& field : observation.groups().back().fields) {
    if (field.kind == SeriesField::Kind::constant) continue;
    if (field.name == "normal_velocity") EXPECT_EQ(row[at + 15], 1);
    // In its own length: 0.2 / 1 and -0.9 / 2, in bins of 0.02 from -1/2 on.
    if (field.name == "arms") EXPECT_EQ(row[at + 35] + row[at + 2], 2);
    at += field.width();
  }
}

// The seven needles in the order of their lengths, ties by id, in classes of 3, 2 and 2.
TEST(BySize, AreClassesOfEqualCountsByRank) {
  std::vector<BodyNumbers> bodies;
  for (const double length : {3.0, 1.0, 2.0, 2.0, 5.0, 2.0, 4.0})
    bodies.push_back({length, 0, length, length / 10});
  Scene scene = of_bodies("displacement", bodies);
  scene.output.size_classes = 3;
  State state = state_of(bodies);
  for (std::size_t i = 0; i < 7; ++i) {
    state.id[i] = static_cast<std::uint32_t>(10 + i);
    state.velocity[i] = {static_cast<double>(i), 0, 0};
    state.angular_velocity[i] = {0, static_cast<double>(i), 0};
  }
  Observation observation(scene, nullptr, {state.id, {}, state.own_bodies});
  const SeriesGroup group = observation.groups().front();
  ASSERT_EQ(group.name, "by_size");
  std::map<std::string, SeriesField> fields;
  for (const SeriesField& field : group.fields) fields.emplace(field.name, field);
  EXPECT_EQ(fields["count"].values, (std::vector<double>{3, 2, 2}));
  EXPECT_EQ(fields["mean_size"].values, (std::vector<double>{(1 + 2 + 2) / 3.0, 2.5, 4.5}));
  EXPECT_EQ(fields["t_tr"].shape.size(), 1u);
  EXPECT_EQ(fields["parallel"].shape.size(), 2u);
  observation.sample(state, {}, {});
  Collision c{};
  c.first = 11, c.second = 14;  // of the first and of the last class
  observation.collision(c);
  for (std::size_t i = 0; i < 7; ++i) state.position[i] = {0, 0, 0.1 * bodies[i].length};
  Totals later;
  later.time = 1;
  const auto row = observation.sample(state, later, {});
  // Needles 1, 2, 3; then 5, 0; then 6, 4.
  expect_near(
      {row.begin(), row.begin() + 9},
      {(1 * 1 + 2 * 4 + 2 * 9) / 9.0, (2 * 25 + 3 * 0) / 6.0, (4 * 36 + 5 * 16) / 6.0,
       0.1 * (1 * 1 + 2 * 4 + 2 * 9) / 6, 0.1 * 2 * 25 / 4, 0.1 * (4 * 36 + 5 * 16) / 4, 1, 0, 1});
  // The displacement of each class, along z as their directors: by reference, after the lags.
  const std::size_t parallel = 9 + 3 * 8;
  expect_near({row[parallel], row[parallel + 8], row[parallel + 16]},
              {0.01 * (1 + 4 + 4) / 3, 0.01 * (4 + 9) / 2, 0.01 * (16 + 25) / 2});
}

TEST(BySize, OfAlikeNeedlesAreClassesOfIds) {
  Scene scene = scene_with("displacement", 4, room);
  scene.output.size_classes = 2;
  State state = resting(4, room);
  for (std::size_t i = 0; i < 4; ++i) state.velocity[i] = {static_cast<double>(i), 0, 0};
  Observation observation(scene, nullptr, {state.id, {}});
  const auto row = observation.sample(state, {}, {});
  EXPECT_NEAR(row[0], 1 / 6.0, 1e-12);
  EXPECT_NEAR(row[1], (4 + 9) / 6.0, 1e-12);
}

// More classes than needles leave some empty.
TEST(BySize, HaveNoNumbersWithoutNeedles) {
  Scene scene = scene_with("displacement", 2, room);
  scene.output.size_classes = 4;
  const State state = resting(2, room);
  Observation observation(scene, nullptr, {state.id, {}});
  const auto row = observation.sample(state, {}, {});
  EXPECT_TRUE(std::isnan(row[1]) && std::isnan(row[3]));
  EXPECT_EQ(row[0], 0);
}

TEST(BySize, GoesOnAsItWas) {
  Scene scene = of_bodies("displacement", three_bodies);
  scene.output.size_classes = 2;
  State state = three_that_differ();
  const auto make = [&] {
    return std::make_unique<Observation>(scene, nullptr,
                                         SpeciesById{state.id, {}, state.own_bodies});
  };
  const auto first = make(), second = make();
  first->sample(state, {}, {});
  Collision c{};
  c.first = 0, c.second = 2;
  first->collision(c);
  std::string saved;
  {
    Archive to = Archive::to(saved);
    first->transfer(to);
  }
  Archive from = Archive::from(saved);
  second->transfer(from);
  Totals later;
  later.time = 2;
  state.position[1] = {3, 2, 1};
  const auto a = first->sample(state, later, {}), b = second->sample(state, later, {});
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0);
}

}  // namespace
}  // namespace needlework::observe
