// Observables where rows of boxes slide, against sums over the images of the instant.
#include <cmath>
#include <numbers>

#include "src/observe/ideal_pairs.h"
#include "tests/observe/observed.h"
#include "tests/support/random.h"

namespace needlework::observe {
namespace {

constexpr std::size_t g_bins = 60;

Scene sheared(const std::string& observable, std::size_t count, const Vector& box, double rate,
              double offset) {
  Scene scene = scene_with(observable, count, box);
  scene.shear = Scene::Shear{rate, offset};
  return scene;
}

TEST(PairCorrelationInShear, CountsThePairsOfAllImages) {
  struct Case {
    Vector box;
    double slide;
  };
  for (const auto& [box, slide] :
       {Case{{13, 12.5, 12.2}, 6.4}, Case{{13, 12.5, 12.2}, 9.9}, Case{{26, 9.2, 9.1}, 12.9},
        Case{{9.2, 9.1, 9.3}, 4.6}, Case{{5, 13, 13}, 1.7}, Case{{12, 4.1, 13}, 11.9}}) {
    const Scene scene = sheared("pair_correlation", 400, box, 0.3, slide);
    State state = draw_initial_state(scene);
    state.slide = slide;
    Values values = Observed(scene).sample(state);
    const double reach = values["borders"].back();
    EXPECT_DOUBLE_EQ(reach, std::min(3.0, *std::ranges::min_element(box) / 2));
    std::vector<double> pairs(g_bins), order(g_bins);
    for (std::size_t i = 0; i < state.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        for (int x = -2; x <= 2; ++x)
          for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
              const Vector apart = minus(state.position[i], state.position[j]);
              const double distance = std::hypot(apart[0] - x * box[0] - y * slide,
                                                 apart[1] - y * box[1], apart[2] - z * box[2]);
              if (distance >= reach) continue;
              const auto bin = static_cast<std::size_t>(distance / reach * g_bins);
              ++pairs[bin];
              order[bin] += second_legendre(dot(state.orientation[i], state.orientation[j]));
            }
    for (std::size_t n = 0; n < g_bins; ++n) {
      const double shell =
          4 * std::numbers::pi / 3 *
          (std::pow(values["borders"][n + 1], 3) - std::pow(values["borders"][n], 3));
      EXPECT_NEAR(values["g"][n] * 400 * 399 / 2 * shell / (box[0] * box[1] * box[2]), pairs[n],
                  1e-6)
          << slide << ' ' << n;
      if (pairs[n] > 0) {
        EXPECT_NEAR(values["p2"][n], order[n] / pairs[n], 1e-9) << slide << ' ' << n;
      }
    }
  }
}

// Drawn needles are independent of each other. Law: counts of each bin are Poisson's, so that the
// sum of their squares has a mean of 60 with the standard error sqrt(120).
TEST(PairCorrelationInShear, OfIndependentNeedlesIsOne) {
  Scene scene = sheared("pair_correlation", 400, {9, 7, 8}, 1, 3.1);
  std::vector<double> sums(g_bins);
  Values values;
  constexpr int draws = 40;
  for (int draw = 0; draw < draws; ++draw) {
    scene.needles.seed = static_cast<std::uint64_t>(100 + draw);
    State state = draw_initial_state(scene);
    state.slide = scene.shear->offset;
    values = Observed(scene).sample(state);
    for (std::size_t n = 0; n < g_bins; ++n) sums[n] += values["g"][n] / draws;
  }
  const std::vector<double> shares = IdealPairs(setting_of(scene)).shares(0, 0, values["borders"]);
  double square = 0;
  for (std::size_t n = 0; n < g_bins; ++n) {
    const double error = 1 / std::sqrt(0.5 * draws * 400 * 399 * shares[n]);
    square += std::pow((sums[n] - 1) / error, 2);
  }
  EXPECT_NEAR(square, 60, 4 * std::sqrt(120));
}

TEST(StructureFactorInShear, IsThatOfAnyImages) {
  const Vector box{8, 9, 10};
  for (const double slide : {0.7, 3.9, 4.2, 7.9}) {
    const Scene scene = sheared("structure_factor", 50, box, 0.3, slide);
    State state = draw_initial_state(scene);
    state.slide = slide;
    Values before = Observed(scene).sample(state);
    test::Random random(3);
    for (Vector& r : state.position) {
      const double x = std::floor(random.uniform(-2, 3)), y = std::floor(random.uniform(-2, 3));
      const double z = std::floor(random.uniform(-2, 3));
      r = {r[0] + x * box[0] + y * slide, r[1] + y * box[1], r[2] + z * box[2]};
    }
    Values after = Observed(scene).sample(state);
    for (std::size_t n = 0; n < 48; ++n) {
      EXPECT_NEAR(after["s"][n], before["s"][n], 1e-10) << slide << ' ' << n;
    }
    for (std::size_t n = 1; n <= 16; ++n) {
      // The least part along y, of which a whole wave along y is the step.
      const double wave = 2 * std::numbers::pi / box[1];
      EXPECT_LE(std::abs(before["k_y"][n - 1]), wave / 2 * (1 + 1e-12));
      const double waves = before["k_y"][n - 1] / wave + double(n) * slide / box[0];
      EXPECT_NEAR(waves, std::round(waves), 1e-12);
    }
  }
}

// Needles at steps of a quarter along x, a fifth along the tilted vector and a half along z.
TEST(StructureFactorInShear, PeaksAtWavesOfTheLattice) {
  const Vector box{8, 9, 10};
  const double slide = 0.31 * box[0];
  State state = resting(40, box);
  state.slide = slide;
  for (std::size_t i = 0; i < 40; ++i) {
    const std::size_t layer = i / 20, row = i / 4 % 5;
    const double a = double(i % 4) / 4, b = double(row) / 5, c = double(layer) / 2;
    state.position[i] = {a * box[0] + b * slide, b * box[1], c * box[2]};
  }
  Values values = Observed(sheared("structure_factor", 40, box, 0.3, slide)).sample(state);
  for (std::size_t n = 1; n <= 16; ++n) {
    const auto above = static_cast<std::size_t>(std::round(0.31 * double(n)));
    EXPECT_NEAR(values["s"][n - 1], n % 4 == 0 && above % 5 == 0 ? 40 : 0, 1e-10) << n;
    EXPECT_NEAR(values["s"][16 + n - 1], n % 5 == 0 ? 40 : 0, 1e-10) << n;
    EXPECT_NEAR(values["s"][32 + n - 1], n % 2 == 0 ? 40 : 0, 1e-10) << n;
    EXPECT_NEAR(values["k_y"][n - 1],
                2 * std::numbers::pi / box[1] * (double(above) - 0.31 * double(n)), 1e-12);
  }
}

TEST(AlignmentInShear, HasAnAngleToTheFlow) {
  State state = resting(6, {5, 5, 5});
  for (std::size_t i = 0; i < 6; ++i) {
    // Mirrored at the director (cos a, sin a, 0) of their order, and across it along z.
    const double angle = -0.6 + (i % 2 == 0 ? 0.2 : -0.2);
    if (i < 4) state.orientation[i] = {std::cos(angle), std::sin(angle), 0};
    state.angular_velocity[i] = {1, 2, i == 0 ? -3.0 : -0.6};
  }
  Values values = Observed(sheared("alignment", 6, {5, 5, 5}, -2, 0)).sample(state);
  EXPECT_NEAR(values["flow_angle"].at(0), -0.6, 1e-14);
  EXPECT_NEAR(values["spin_over_rate"].at(0), 0.5, 1e-14);
  EXPECT_EQ(Observed(scene_with("alignment", 6, {5, 5, 5})).sample(state).count("flow_angle"), 0u);
}

// Needles that fly freely: c_x falls by rate * c_y, and paths along y and z are straight.
TEST(DisplacementInShear, IsBesideTheFlow) {
  for (const char* name : {"displacement", "time_correlation"}) {
    Scene scene = sheared(name, 50, {3000, 3000, 3000}, 0.8, 700);
    scene.species = {{.name = "a", .count = 30}, {.name = "b", .count = 20}};
    Simulation simulation(scene);
    Observation observation(scene);
    const State start = simulation.copy();
    const auto sample = [&] {
      State state = simulation.copy();
      state.velocity = state.peculiar_velocity;
      SpeciesSums sums;
      sums.totals = simulation.species_totals();
      sums.collisions = simulation.collisions_by_pair();
      sums.energy = simulation.energy_budget();
      sums.stress = *simulation.stress_sums();
      return observation.sample(state, simulation.totals(), sums);
    };
    sample();
    Scene::Until until;
    until.time = 4000;  // across several boxes, whose rows slide by as many
    simulation.advance(until);
    ASSERT_LT(simulation.collisions(), 3u);
    auto value = sample().begin();
    Values values;
    for (const SeriesGroup& group : observation.groups())
      for (const SeriesField& field : group.fields) {
        if (field.kind == SeriesField::Kind::constant) continue;
        values[group.name + '/' + field.name].assign(value, value + std::ptrdiff_t(field.width()));
        value += std::ptrdiff_t(field.width());
      }
    for (std::size_t species = 0; species < 2; ++species) {
      double square = 0, count = 0, velocity = 0;
      for (std::size_t i = 0; i < start.size(); ++i) {
        if (start.species[i] != species) continue;
        const auto& c = start.peculiar_velocity[i];
        const double x = c[0] * *until.time - 0.8 * c[1] * *until.time * *until.time / 2;
        square += x * x + (c[1] * c[1] + c[2] * c[2]) * *until.time * *until.time;
        velocity += c[0] * (c[0] - 0.8 * c[1] * *until.time) + c[1] * c[1] + c[2] * c[2];
        ++count;
      }
      const std::string field = std::string(name) + '/';
      const bool has_lags = field == "time_correlation/";
      const std::size_t width = values[field + "parallel"].size() / 2;
      const std::size_t place = species * width + (has_lags ? 1 : 0);
      const double whole =
          values[field + "parallel"][place] + values[field + "perpendicular"][place];
      EXPECT_NEAR(whole / (square / count), 1, 1e-9) << name;
      if (!has_lags) continue;
      EXPECT_NEAR(values[field + "velocity"][place] / (velocity / count), 1, 1e-9);
    }
  }
}

}  // namespace
}  // namespace needlework::observe
