// Initial states: exact temperatures and momentum, and the distributions they are drawn from.
// Tolerances of statistical tests are 4 standard errors: one seed in 16000 fails one such test.
#include "needlework/initial_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "needlework/simulation.h"
#include "tests/support/cpu_seconds.h"

namespace needlework {
namespace {

using Vector = std::array<double, 3>;

Scene scene_of(std::uint64_t count, std::uint64_t seed = 1) {
  Scene scene;
  scene.needles.count = count;
  scene.needles.box = {12, 4, 100};
  scene.needles.seed = seed;
  return scene;
}

// In long double: these sums have to be better than what they test.
long double mean(const std::vector<Vector>& vectors,
                 const std::function<long double(const Vector&)>& f) {
  long double sum = 0;
  for (const Vector& v : vectors) sum += f(v);
  return sum / static_cast<long double>(vectors.size());
}

long double dot(const Vector& a, const Vector& b) {
  long double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += static_cast<long double>(a[i]) * b[i];
  return sum;
}

long double mean_square(const std::vector<Vector>& vectors) {
  return mean(vectors, [](const Vector& v) { return dot(v, v); });
}

double t_tr(const State& state) { return static_cast<double>(mean_square(state.velocity) / 3); }

double t_rot(const State& state, double k) {
  const double inertia = 1 / (2 * k);
  return static_cast<double>(inertia * mean_square(state.angular_velocity) / 2);
}

constexpr double few_ulp = 4 * 0x1p-52;

TEST(InitialState, HasExactlyTheTemperaturesAskedFor) {
  for (const std::uint64_t count : {1, 2, 3, 10, 1000, 100000})
    for (const double t : {1.0, 0.37, 1e-199, 1e200})
      for (const double k : {6.0, 0.1, 1e9}) {
        Scene scene = scene_of(count, count + 7);
        scene.needles.k = k;
        scene.initial.t_tr = t;
        scene.initial.t_rot = 3 * t / 7;
        const State state = draw_initial_state(scene);
        EXPECT_NEAR(t_tr(state) / t, 1, few_ulp) << count << ' ' << t;
        EXPECT_NEAR(t_rot(state, k) / scene.initial.t_rot, 1, few_ulp) << count << ' ' << k;
      }
}

TEST(InitialState, HasNoMomentumFromTwoNeedlesOn) {
  for (const std::uint64_t count : {2, 3, 10, 1000, 100000}) {
    const State state = draw_initial_state(scene_of(count));
    for (std::size_t i = 0; i < 3; ++i) {
      const long double momentum =
          mean(state.velocity, [i](const Vector& v) { return v[i]; }) * count;
      EXPECT_LE(std::abs(static_cast<double>(momentum)), 1e-14 * static_cast<double>(count))
          << count;
    }
  }
}

TEST(InitialState, OfTemperatureZeroIsAtRest) {
  Scene scene = scene_of(10);
  scene.initial.t_rot = 0;
  State state = draw_initial_state(scene);
  EXPECT_NEAR(t_tr(state), 1, few_ulp);
  for (const Vector& w : state.angular_velocity)
    for (const double x : w) EXPECT_TRUE(x == 0 && !std::signbit(x));
  scene.initial = {0.0, 2.0, ""};
  state = draw_initial_state(scene);
  for (const Vector& v : state.velocity)
    for (const double x : v) EXPECT_TRUE(x == 0 && !std::signbit(x));
  EXPECT_NEAR(t_rot(state, 6), 2, 2 * few_ulp);
}

TEST(InitialState, OfNoNeedlesIsEmpty) {
  const State state = draw_initial_state(scene_of(0));
  EXPECT_EQ(state.size(), 0u);
  EXPECT_EQ(state.box, (Vector{12, 4, 100}));
}

TEST(InitialState, LiesInTheBoxWithUnitDirectorsAndNormalRotation) {
  const State state = draw_initial_state(scene_of(100000));
  ASSERT_EQ(state.velocity.size(), 100000u);
  ASSERT_EQ(state.orientation.size(), 100000u);
  for (std::size_t n = 0; n < state.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_TRUE(state.position[n][i] >= 0 && state.position[n][i] < state.box[i]);
    const Vector& u = state.orientation[n];
    const Vector& w = state.angular_velocity[n];
    ASSERT_NEAR(static_cast<double>(dot(u, u)), 1, 4 * 0x1p-53);
    ASSERT_LE(std::abs(static_cast<double>(dot(u, w))),
              4 * 0x1p-53 * std::sqrt(static_cast<double>(dot(w, w))));
  }
}

TEST(InitialState, OfANeedleDoesNotDependOnTheOthers) {
  const State few = draw_initial_state(scene_of(10));
  const State many = draw_initial_state(scene_of(1000));
  for (std::size_t n = 0; n < few.size(); ++n) {
    EXPECT_EQ(few.position[n], many.position[n]);
    EXPECT_EQ(few.orientation[n], many.orientation[n]);
    // One common factor makes the temperature exact.
    const double factor = few.angular_velocity[n][0] / many.angular_velocity[n][0];
    const double expected = few.angular_velocity[0][0] / many.angular_velocity[0][0];
    EXPECT_NEAR(factor, expected, 1e-14);
  }
  EXPECT_NE(draw_initial_state(scene_of(10, 2)).position, few.position) << "the seed is ignored";
}

// Golden bits: they change only when the drawing is changed, never with machine or compiler.
TEST(InitialState, HasTheSameBitsOnEveryMachine) {
  const State state = draw_initial_state(scene_of(1000, 42));
  EXPECT_EQ(state.position[0],
            (Vector{0x1.f6397a879e59cp+2, 0x1.316062ae59274p+0, 0x1.6db0f9b76c5aap+6}));
  EXPECT_EQ(state.orientation[0],
            (Vector{-0x1.57f92d6aaca9ep-2, 0x1.96f684ce4eacfp-2, -0x1.b537e4a2e8918p-1}));
  EXPECT_EQ(state.velocity[0],
            (Vector{-0x1.4dfae6a22a66cp+0, -0x1.9f4cfcde48052p+0, -0x1.1855046ed4867p-2}));
  EXPECT_EQ(state.angular_velocity[0],
            (Vector{0x1.7c6f3f42eedb4p+1, -0x1.d7a9774d7d1bfp-1, -0x1.990e38f92a70cp+0}));
  EXPECT_EQ(state.velocity[999],
            (Vector{-0x1.f7602c02e8353p+0, -0x1.e47aed4ea5c0fp-1, -0x1.41d23253af5f5p+1}));
  EXPECT_EQ(state.angular_velocity[999],
            (Vector{0x1.0bf32fa85ffd5p+1, -0x1.9eea795846173p+1, -0x1.8895224eda2c8p+1}));
}

// Kolmogorov and Smirnov: sqrt(N) times the largest distance between the distribution of `sample`
// and `law`. Above 2.23 by chance once in 10 000 (Kolmogorov's limit law, 2 exp(-2 x^2)).
double kolmogorov_smirnov(std::vector<double> sample, const std::function<double(double)>& law) {
  std::sort(sample.begin(), sample.end());
  const double n = static_cast<double>(sample.size());
  double distance = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double p = law(sample[i]);
    const double rank = static_cast<double>(i);
    distance = std::max({distance, p - rank / n, (rank + 1) / n - p});
  }
  return distance * std::sqrt(n);
}

std::vector<double> component(const std::vector<Vector>& vectors, std::size_t i) {
  std::vector<double> values;
  for (const Vector& v : vectors) values.push_back(v[i]);
  return values;
}

constexpr double ks_limit = 2.23;

class Distribution : public testing::Test {
 protected:
  static constexpr std::size_t n_ = 200000;
  const double k_ = 6;
  const State state_ = draw_initial_state(scene_of(n_, 20240229));
};

TEST_F(Distribution, OfCentresIsUniform) {
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(kolmogorov_smirnov(component(state_.position, i),
                                 [&](double x) { return x / state_.box[i]; }),
              ks_limit);
}

TEST_F(Distribution, OfDirectorsIsUniformOnTheSphere) {
  // Archimedes: each component is uniform on [-1, 1]; and so is the azimuth on its circle.
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(
        kolmogorov_smirnov(component(state_.orientation, i), [](double x) { return (x + 1) / 2; }),
        ks_limit);
  std::vector<double> azimuth;
  for (const Vector& u : state_.orientation) azimuth.push_back(std::atan2(u[1], u[0]));
  EXPECT_LT(kolmogorov_smirnov(azimuth, [](double x) { return x / (2 * std::numbers::pi) + 0.5; }),
            ks_limit);
}

double normal_law(double x) { return std::erfc(-x / std::numbers::sqrt2) / 2; }

TEST_F(Distribution, OfVelocitiesIsNormal) {
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(kolmogorov_smirnov(component(state_.velocity, i), normal_law), ks_limit);
}

TEST_F(Distribution, OfAngularVelocitiesIsNormal) {
  // In any fixed direction d, w.d is normal of variance 2 k T (1 - (u.d)^2).
  const double variance = 2 * k_;
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> scaled;
    for (std::size_t n = 0; n < n_; ++n) {
      const double u = state_.orientation[n][i];
      scaled.push_back(state_.angular_velocity[n][i] / std::sqrt(variance * (1 - u * u)));
    }
    EXPECT_LT(kolmogorov_smirnov(scaled, normal_law), ks_limit);
  }
  // Two degrees of freedom: w^2 / (2 variance) is exponential.
  std::vector<double> energy;
  for (const Vector& w : state_.angular_velocity)
    energy.push_back(static_cast<double>(dot(w, w)) / (2 * variance));
  EXPECT_LT(kolmogorov_smirnov(energy, [](double x) { return -std::expm1(-x); }), ks_limit);
}

// Expects the mean of `values` to be `expected` within 4 standard errors of a deviate with the
// given variance.
void expect_mean(const std::vector<double>& values, double expected, double variance) {
  double sum = 0;
  for (const double x : values) sum += x;
  const double n = static_cast<double>(values.size());
  EXPECT_NEAR(sum / n, expected, 4 * std::sqrt(variance / n));
}

TEST_F(Distribution, OfVelocitiesHasNormalMoments) {
  // <x^4> = 3, <x^6> = 15, <x^8> = 105 and <x^12> = 10395.
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> fourth, sixth;
    for (const Vector& v : state_.velocity) {
      fourth.push_back(std::pow(v[i], 4));
      sixth.push_back(std::pow(v[i], 6));
    }
    expect_mean(fourth, 3, 105 - 9);
    expect_mean(sixth, 15, 10395 - 225);
  }
}

TEST_F(Distribution, OfEachKindIsIndependentOfTheOthers) {
  const auto product = [&](auto f, auto g) {
    std::vector<double> values;
    for (std::size_t n = 0; n < n_; ++n) values.push_back(f(n) * g(n));
    return values;
  };
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const auto r = [&](std::size_t n) { return state_.position[n][i] / state_.box[i] - 0.5; };
      const auto u = [&](std::size_t n) { return state_.orientation[n][j]; };
      const auto v = [&](std::size_t n) { return state_.velocity[n][j]; };
      const auto w = [&](std::size_t n) { return state_.angular_velocity[n][i]; };
      const auto next_v = [&](std::size_t n) { return state_.velocity[(n + 1) % n_][i]; };
      const double w2 = 2 * k_ * 2 / 3;  // <w_i^2>, with <1 - u_i^2> = 2/3
      expect_mean(product(r, u), 0, 1.0 / 12 / 3);
      expect_mean(product(r, v), 0, 1.0 / 12);
      expect_mean(product(w, v), 0, w2);
      expect_mean(product(next_v, v), 0, 1);
      if (i != j)
        expect_mean(product([&](std::size_t n) { return state_.velocity[n][i]; }, v), 0, 1);
    }
}

// 100 times as many needles take about 100 times as long, not 10000 times.
TEST(InitialState, CostsInProportionToTheNeedles) {
  const auto cost = [](std::uint64_t count) {
    return test::cpu_seconds([&] { EXPECT_EQ(draw_initial_state(scene_of(count)).size(), count); });
  };
  EXPECT_LT(cost(1000000), 1000 * cost(10000));
}

Scene walled(std::uint64_t count, std::vector<Scene::Wall> walls) {
  Scene scene = scene_of(count);
  scene.needles.box = {4, 5, 6};
  scene.walls = std::move(walls);
  return scene;
}

Scene::Wall wall(const char* axis, const char* side) {
  Scene::Wall out;
  out.axis = axis;
  out.side = side;
  return out;
}

// Positions are those of an ideal gas, where both tips are inside: at the distance d < L/2 from a
// wall the density is 2 d / L of what it is in the middle, and |u_z| is uniform up to that.
TEST(InitialStateBetweenWalls, HasItsDepletionAtThem) {
  constexpr std::uint64_t count = 200000;
  const State state = draw_initial_state(walled(count, {wall("z", "both")}));
  const double height = 6;
  double near = 0, nearer = 0, low = 0, cosines = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = state.position[i][2], reach = std::abs(state.orientation[i][2]) / 2;
    ASSERT_GT(z - reach, 0);
    ASSERT_LT(z + reach, height);
    const double d = std::min(z, height - z);
    low += z < height / 2;
    near += d < 0.5;
    nearer += d < 0.25;
    if (d < 0.5) cosines += reach / d;  // uniform on [0, 1]
  }
  const auto expect_share = [&](double found, double share) {
    EXPECT_NEAR(found / count, share, 4 * std::sqrt(share * (1 - share) / count));
  };
  expect_share(low, 0.5);
  expect_share(near, 2 * 0.25 / (height - 0.5));
  expect_share(nearer, 2 * 0.0625 / (height - 0.5));
  EXPECT_NEAR(cosines / near, 0.5, 4 * std::sqrt(1 / (12 * near)));
}

TEST(InitialStateBetweenWalls, LiesInsideAllOfThem) {
  Scene::Wall raised = wall("z", "low"), lifted = wall("z", "high");
  raised.motion = {.amplitude = 2, .frequency = 3, .phase = 1.5707963267948966};
  lifted.motion = {.amplitude = 1, .frequency = 3, .phase = 1.5707963267948966};
  Scene scene = walled(20000, {wall("x", "both"), raised, lifted});
  scene.species = {{.name = "long", .count = 10000, .length = 3},
                   {.name = "short", .count = 10000, .length = 0.5}};
  scene.needles.box[1] = 7;
  const State state = draw_initial_state(scene);
  double lowest = 9, highest = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double half = (state.species[i] == 0 ? 3 : 0.5) / 2;
    for (const double tip : {-half, half}) {
      const double x = state.position[i][0] + tip * state.orientation[i][0];
      const double z = state.position[i][2] + tip * state.orientation[i][2];
      ASSERT_GT(x, 0);
      ASSERT_LT(x, 4);
      ASSERT_GT(z, 2);
      ASSERT_LT(z, 7);
      lowest = std::min(lowest, z);
      highest = std::max(highest, z);
    }
  }
  EXPECT_NEAR(lowest, 2, 0.1);
  EXPECT_NEAR(highest, 7, 0.1);
  EXPECT_NEAR(t_tr(state), 1, 0.1);
}

TEST(InitialStateBetweenWalls, HasRoomForOneLength) {
  Scene scene = walled(1000, {wall("x", "both"), wall("y", "both"), wall("z", "both")});
  scene.needles.box = {1, 1, 1};
  EXPECT_EQ(draw_initial_state(scene).size(), 1000u);
}

TEST(InitialStateAboveAFloor, IsDrawnInTheBox) {
  Scene scene = walled(10000, {wall("z", "low")});
  scene.forces.gravity = {0, 0, -1};
  const State state = draw_initial_state(scene);
  double highest = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    ASSERT_GT(state.position[i][2] - std::abs(state.orientation[i][2]) / 2, 0);
    highest = std::max(highest, state.position[i][2]);
  }
  EXPECT_GT(highest, 5.9);
  EXPECT_LT(highest, 6);
}

}  // namespace
}  // namespace needlework
