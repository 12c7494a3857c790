// Observables of mixtures: of each species on its own, or of each two of them.
#include <cmath>
#include <cstring>
#include <limits>

#include "src/observe/cooling_theory.h"
#include "src/observe/registry.h"
#include "tests/observe/observed.h"

namespace needlework::observe {
namespace {

Scene mixture() {
  Scene scene;
  scene.needles.box = {6, 7, 8};
  scene.needles.seed = 11;
  scene.species = {{.name = "a", .count = 60, .length = 0.5, .mass = 2, .k = 3, .t_tr = 2},
                   {.name = "b", .count = 90, .length = 1.5, .mass = 0.5, .k = 6, .t_rot = 0.3}};
  scene.needles.count = 150;
  scene.collisions.epsilon = 0.8;
  scene.collisions.tc_relative = 1e-3;
  scene.output.grid = std::array{2, 3, 4};
  return scene;
}

SpeciesById species_of(const Simulation& simulation) {
  State state = simulation.copy();
  return {std::move(state.id), std::move(state.species)};
}

SpeciesSums sums_of(const Simulation& simulation) {
  return {simulation.species_totals(), simulation.collisions_by_pair()};
}

/// The rows of one observable by the names of its fields.
Values rows_of(const SeriesGroup& group, std::span<const double> row) {
  Values out;
  for (const SeriesField& field : group.fields) {
    if (field.kind == SeriesField::Kind::constant) {
      EXPECT_EQ(field.values.size(), field.width()) << field.name;
      out[field.name] = field.values;
      continue;
    }
    out[field.name].assign(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(field.width()));
    row = row.subspan(field.width());
  }
  EXPECT_TRUE(row.empty());
  return out;
}

/// The needles of one species as a gas of their own.
struct Alone {
  Scene scene = mixture();
  State state;
  Totals totals;

  Alone(const Simulation& simulation, std::size_t species, const std::string& name) {
    const State all = simulation.copy();
    state.box = all.box;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all.species[i] != species) continue;
      state.position.push_back(all.position[i]);
      state.velocity.push_back(all.velocity[i]);
      state.orientation.push_back(all.orientation[i]);
      state.angular_velocity.push_back(all.angular_velocity[i]);
      state.image.push_back(all.image[i]);
      state.id.push_back(all.id[i]);
    }
    scene.species = {scene.species[species]};
    scene.needles.count = state.size();
    scene.output.observables = {name};
    totals.time = simulation.time();
    totals.t_tr = simulation.species_totals()[species].t_tr;
    totals.t_rot = simulation.species_totals()[species].t_rot;
  }
};

TEST(BySpecies, IsWhatEachSpeciesHasAlone) {
  Simulation simulation(mixture());
  simulation.advance(test::until_time(2));
  int seen = 0;
  for (const Entry& entry : registry()) {
    if (entry.knows_species) continue;
    ++seen;
    Scene scene = mixture();
    scene.output.observables = {std::string(entry.name)};
    Observation both(scene);
    const SeriesGroup group = both.groups().at(1);
    const auto row = both.sample(simulation.copy(), simulation.totals(), sums_of(simulation));
    const std::size_t of_sums = 2 + 2 + 3;
    const Values found = rows_of(group, row.subspan(of_sums));
    std::vector<Values> expected;
    for (const std::size_t species : {0, 1}) {
      const Alone alone(simulation, species, std::string(entry.name));
      Observation one(alone.scene);
      expected.push_back(rows_of(one.groups().at(0), one.sample(alone.state, alone.totals)));
    }
    for (const SeriesField& field : group.fields) {
      const bool is_shared =
          field.kind == SeriesField::Kind::constant && field.shape.front().name != "species";
      std::vector<double> both_values;
      for (const Values& each : expected) {
        // More needles in all give more occupations of a cell, of which the last have no cells.
        std::vector<double> values = each.at(field.name);
        if (field.name == "needles_in_cell") values.resize(found.at(field.name).size() / 2);
        both_values.insert(both_values.end(), values.begin(), values.end());
        if (is_shared) break;
      }
      ASSERT_EQ(found.at(field.name).size(), both_values.size()) << entry.name << field.name;
      for (std::size_t n = 0; n < both_values.size(); ++n) {
        const double value = found.at(field.name)[n];
        EXPECT_TRUE(value == both_values[n] || (std::isnan(value) && std::isnan(both_values[n])))
            << entry.name << ", " << field.name << " " << n;
      }
    }
  }
  EXPECT_EQ(seen, 10);
}

TEST(BySpecies, SumsAreThoseOfTheSimulation) {
  Simulation simulation(mixture());
  simulation.advance(test::until_time(2));
  Observation sums(mixture());
  ASSERT_EQ(sums.groups().size(), 1u);
  EXPECT_FALSE(sums.reads_state());
  const Values found =
      rows_of(sums.groups()[0], sums.sample({}, simulation.totals(), sums_of(simulation)));
  for (const std::size_t species : {0, 1}) {
    EXPECT_EQ(found.at("t_tr")[species], simulation.species_totals()[species].t_tr);
    EXPECT_EQ(found.at("t_rot")[species], simulation.species_totals()[species].t_rot);
  }
  EXPECT_EQ(sum(found.at("collisions")), static_cast<double>(simulation.collisions()));
  EXPECT_GT(found.at("collisions")[1], 0);
}

// One needle of a beside one of b, and two of b near each other.
TEST(PairCorrelationOfSpecies, CountsPairsOfEachTwo) {
  Scene scene = mixture();
  scene.species[0].count = 1;
  scene.species[1].count = 3;
  scene.needles.count = 4;
  scene.output.observables = {"pair_correlation"};
  State state = resting(4, scene.needles.box);
  state.species = {0, 1, 1, 1};
  state.position = {{1, 1, 1}, {1, 1, 1.31}, {4, 4, 4}, {4, 4.61, 4}};
  state.orientation[1] = {0, 1, 0};
  SpeciesSums sums{{{1, 1, 1}, {3, 1, 1}}, {0, 0, 0}};
  Observation observation(scene);
  const auto row = observation.sample(state, {}, sums);
  const Values found = rows_of(observation.groups().at(1), row.subspan(7));
  const std::vector<double>& borders = found.at("borders");
  const std::size_t bins = borders.size() - 1;
  EXPECT_EQ(borders.back(), 3);  // half of the shortest edge
  const auto bin_of = [&](double r) { return static_cast<std::size_t>(r / borders.back() * bins); };
  const auto g = [&](double pairs, std::size_t bin) {
    const double shell =
        4 * std::acos(-1) / 3 * (std::pow(borders[bin + 1], 3) - std::pow(borders[bin], 3));
    return 1 / (pairs * shell / (6 * 7 * 8));
  };
  ASSERT_EQ(found.at("g").size(), 3 * bins);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    EXPECT_TRUE(std::isnan(found.at("g")[bin])) << "no pair of the only needle of a";
    EXPECT_NEAR(found.at("g")[bins + bin], bin == bin_of(0.31) ? g(3, bin) : 0, 1e-9) << bin;
    EXPECT_NEAR(found.at("g")[2 * bins + bin], bin == bin_of(0.61) ? g(3, bin) : 0, 1e-9) << bin;
  }
  EXPECT_EQ(found.at("p2")[bins + bin_of(0.31)], -0.5);
  EXPECT_EQ(found.at("p2")[2 * bins + bin_of(0.61)], 1);
}

TEST(StructureFactorOfSpecies, IsNegativeWhereOneIsInTheGapsOfTheOther) {
  Scene scene = mixture();
  scene.needles.box = {8, 8, 8};
  scene.species[0].count = scene.species[1].count = 8;
  scene.needles.count = 16;
  scene.output.observables = {"structure_factor"};
  State state = resting(16, scene.needles.box);
  state.species.assign(16, 0);
  for (std::size_t n = 0; n < 8; ++n) {
    state.position[n] = {static_cast<double>(n % 4) * 2, 0, 0};
    state.position[8 + n] = {static_cast<double>(n % 4) * 2 + 1, 0, 0};
    state.species[8 + n] = 1;
  }
  Observation observation(scene);
  const auto row = observation.sample(state, {}, {{{8, 1, 1}, {8, 1, 1}}, {0, 0, 0}});
  const auto s = rows_of(observation.groups().at(1), row.subspan(7)).at("s");
  const std::size_t waves = s.size() / 9, fourth = 3;  // four waves along x
  EXPECT_NEAR(s[fourth], 8, 1e-12);
  EXPECT_NEAR(s[3 * waves + fourth], -8, 1e-12);
  EXPECT_NEAR(s[6 * waves + fourth], 8, 1e-12);
  EXPECT_NEAR(s[3 * waves], 0, 1e-12);
}

// The counts of one species told as two, added up, are those of the one.
TEST(CollisionStatisticsOfSpecies, AddUpToThoseOfAll) {
  Scene one = test::scene_of(200, 6, 5);
  one.needles.k = 3;
  one.collisions = {.epsilon = 0.6, .beta = -1, .tc = 1e-4, .tc_relative = {}};
  one.output.observables = {"collision_statistics"};
  Scene two = one;
  two.species = {{.name = "a", .count = 80, .k = 3}, {.name = "b", .count = 120, .k = 3}};
  std::vector<Values> found;
  for (const Scene& scene : {one, two}) {
    Simulation simulation(scene);
    Observation observation(scene, nullptr, species_of(simulation));
    simulation.on_collision([&](const Collision& c) { observation.collision(c); });
    // Of the same temperatures, as each species has its own.
    SpeciesSums equal{{{80, 1, 1}, {120, 1, 1}}, {0, 0, 0}};
    Totals unit;
    unit.t_tr = unit.t_rot = 1;
    observation.sample({}, unit, equal);
    simulation.advance(test::until_collisions(30));
    const auto row = observation.sample({}, unit, equal);
    const bool is_mixture = !scene.species.empty();
    found.push_back(rows_of(observation.groups().back(), row.subspan(is_mixture ? 7 : 0)));
    if (!is_mixture) continue;
    const auto by_pair = simulation.collisions_by_pair();
    for (std::size_t pair = 0; pair < 3; ++pair) {
      EXPECT_EQ(found.back().at("collisions")[pair], static_cast<double>(by_pair[pair]));
    }
  }
  for (const char* name : {"collisions", "repeats", "chains", "arms", "angle", "normal_velocity"}) {
    const std::vector<double>&whole = found[0].at(name), &parts = found[1].at(name);
    ASSERT_EQ(parts.size(), 3 * whole.size()) << name;
    EXPECT_GT(sum(whole), 100) << name;
    for (std::size_t n = 0; n < whole.size(); ++n) {
      EXPECT_EQ(parts[n] + parts[whole.size() + n] + parts[2 * whole.size() + n], whole[n])
          << name << n;
    }
  }
}

TEST(BySpecies, GoesOnAsItWas) {
  Scene scene = mixture();
  for (const Entry& entry : registry()) scene.output.observables.emplace_back(entry.name);
  Simulation simulation(scene);
  const auto make = [&] {
    return make_mixture_theory(scene.composition(), 6 * 7 * 8, {{2, 1}, {1, 0.3}});
  };
  Observation first(scene, make(), species_of(simulation));
  Observation second(scene, make(), species_of(simulation));
  Observation* reader = &first;
  simulation.on_collision([&](const Collision& c) {
    first.collision(c);
    if (reader == &second) second.collision(c);
  });
  for (const double time : {0.0, 0.5, 1.0}) {
    simulation.advance(test::until_time(time));
    first.sample(simulation.copy(), simulation.totals(), sums_of(simulation));
  }
  simulation.advance(test::until_time(1.2));
  std::string saved;
  {
    Archive to = Archive::to(saved);
    first.transfer(to);
  }
  Archive from = Archive::from(saved);
  second.transfer(from);
  reader = &second;
  simulation.advance(test::until_time(3));
  const auto a = first.sample(simulation.copy(), simulation.totals(), sums_of(simulation));
  const auto b = second.sample(simulation.copy(), simulation.totals(), sums_of(simulation));
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0);
}

TEST(MixtureTheory, IsTheCurveAtTheTimesOfTheSamples) {
  const Composition composition = mixture().composition();
  const std::vector<theory::Temperatures> initial{{2, 1}, {1, 0.3}};
  Observation observation(mixture(), make_mixture_theory(composition, 6 * 7 * 8, initial));
  const SpeciesSums sums{{{60, 2, 1}, {90, 1, 0.3}}, {0, 0, 0}};
  for (const double time : {0.0, 0.3, 5.0, 1e3}) {
    Totals totals;
    totals.time = time;
    const auto row = observation.sample({}, totals, sums);
    const Values found = rows_of(observation.groups().at(1), row.subspan(7));
    const auto expected =
        theory::mixture_cooling(composition, 6 * 7 * 8, initial, std::span(&time, 1)).front();
    for (const std::size_t species : {0, 1}) {
      const theory::Temperatures& each = expected[species];
      EXPECT_NEAR(found.at("species_t_tr")[species], each.t_tr, 1e-7 * each.t_tr) << time;
      EXPECT_NEAR(found.at("species_t_rot")[species], each.t_rot, 1e-7 * each.t_rot) << time;
    }
    EXPECT_NEAR(found.at("energy")[0], 0.4 * expected[0].energy() + 0.6 * expected[1].energy(),
                1e-7 * found.at("energy")[0]);
  }
  observation.velocities_set();
  const auto row = observation.sample({}, {}, sums);
  EXPECT_TRUE(std::isnan(row[7]) && std::isnan(row.back()));
}

}  // namespace
}  // namespace needlework::observe
