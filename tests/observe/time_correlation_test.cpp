// Correlation functions of needles whose motion is known, and of gases: free needles, and the exact
// decay of velocities at first, at every density.
#include <cmath>
#include <map>
#include <vector>

#include "needlework/diffusion.h"
#include "tests/observe/observed.h"
#include "tests/support/statistics.h"

namespace needlework::observe {
namespace {

std::vector<std::size_t> lags_up_to(std::size_t most) {
  std::vector<std::size_t> out;
  for (std::size_t lag = 0; lag <= 8; ++lag) out.push_back(lag);
  for (std::size_t step = 2; 5 * step <= most; step *= 2)
    for (std::size_t lag = 5; lag <= 8; ++lag) out.push_back(lag * step);
  return out;
}

TEST(TimeCorrelation, OfKnownMotionIsKnownAtEachLag) {
  Observed observed(scene_with("time_correlation", 4, flying_box));
  const std::vector<std::size_t> lags = lags_up_to(8 << 13);
  std::map<std::size_t, int> seen;
  for (int now = 0; now <= 700; ++now) {
    Values values = observed.sample(flying(0.25 * now), 0.25 * now);
    ASSERT_EQ(values["samples"], (std::vector<double>(lags.begin(), lags.end())));
    for (std::size_t n = 0; n < lags.size(); ++n) {
      const double lag = 0.25 * double(lags[n]), t = 0.25 * now, t0 = t - lag;
      // Where the step of the lag divides both ends.
      const std::size_t step = n <= 8 ? 1 : std::size_t{1} << ((n - 9) / 4 + 1);
      if (std::size_t(now) < lags[n] || std::size_t(now) % step != 0) {
        for (const char* name :
             {"lag", "parallel", "perpendicular", "p1", "p2", "velocity", "velocity_parallel",
              "velocity_perpendicular", "angular_velocity"}) {
          ASSERT_TRUE(std::isnan(values[name][n])) << name << " " << lags[n] << " at " << now;
        }
        continue;
      }
      ++seen[lags[n]];
      const double a0 = 0.5 * t0, a = 0.5 * t, turned = std::cos(a - a0);
      const double along_then = 3 * std::sin(a0) + 4 * std::cos(a0);
      const double along_now = 3 * std::sin(a) + 4 * std::cos(a);
      const double across_then = 3 * std::cos(a0) - 4 * std::sin(a0);
      const double across_now = 3 * std::cos(a) - 4 * std::sin(a);
      const double decay = std::pow(0.99, t0 + t);
      ASSERT_NEAR(values["lag"][n], lag, 1e-12);
      ASSERT_NEAR(values["parallel"][n], std::pow(lag * along_then, 2), 1e-8);
      ASSERT_NEAR(values["perpendicular"][n], std::pow(lag * across_then, 2), 1e-8);
      ASSERT_NEAR(values["p1"][n], turned, 1e-12);
      ASSERT_NEAR(values["p2"][n], 1.5 * turned * turned - 0.5, 1e-12);
      ASSERT_NEAR(values["velocity"][n], 25 * decay, 1e-12);
      ASSERT_NEAR(values["velocity_parallel"][n], along_then * along_now * decay, 1e-12);
      ASSERT_NEAR(values["velocity_perpendicular"][n], across_then * across_now * turned * decay,
                  1e-12);
      ASSERT_NEAR(values["angular_velocity"][n], 0.25 * decay, 1e-12);
    }
  }
  EXPECT_EQ(seen[1], 700);
  EXPECT_EQ(seen[10], (700 - 10) / 2 + 1);
  EXPECT_EQ(seen[640], (700 - 640) / 128 + 1);
}

// Rows that a run gives whose observables have gone through an archive halfway, and others; and
// what no run can have left is refused.
TEST(TimeCorrelation, GoesOnFromAnArchive) {
  const Scene scene = scene_with("time_correlation", 4, flying_box);
  const auto rows = [](Observation& observation, int from, int to) {
    std::vector<double> out;
    for (int now = from; now < to; ++now) {
      const auto row = observation.sample(flying(now), totals_of(flying(now), 1, now));
      for (const double value : row) out.push_back(std::isnan(value) ? -1e300 : value);
    }
    return out;
  };
  for (const int halfway : {0, 1, 5, 64, 257}) {
    Observation whole(scene), first(scene), second(scene);
    const std::vector<double> before = rows(whole, 0, halfway);
    const std::vector<double> after = rows(whole, halfway, 600);
    EXPECT_EQ(rows(first, 0, halfway), before);
    std::string bytes;
    Archive to = Archive::to(bytes);
    first.transfer(to);
    EXPECT_LT(bytes.size(), 60u * 4 * 96 + 4000) << "few states are kept";
    Archive from = Archive::from(bytes);
    second.transfer(from);
    from.require_end();
    EXPECT_EQ(rows(second, halfway, 600), after);
    if (halfway == 0) continue;
    ++bytes[0];  // one sample more, the states of which are not there
    Observation third(scene);
    Archive forged = Archive::from(bytes);
    EXPECT_THROW(third.transfer(forged), InputError);
  }
}

// Of a gas so thin that nothing collides: each needle's own motion, which its record gives.
TEST(TimeCorrelation, OfFreeNeedlesIsThatOfTheirRotation) {
  Scene scene = scene_with("time_correlation", 300, {4000, 4000, 4000});
  Observation observation(scene);
  Simulation simulation(scene);
  const State start = simulation.copy();
  Values values;
  for (int now = 0; now <= 64; ++now) {
    Scene::Until until;
    until.time = 0.05 * now;
    if (now > 0) simulation.advance(until);
    const auto row = observation.sample(simulation.copy(), simulation.totals());
    const auto groups = observation.groups();
    auto next = row.begin();
    for (const SeriesField& field : groups.back().fields) {
      if (field.kind == SeriesField::Kind::constant) continue;
      values[field.name].assign(next, next + std::ptrdiff_t(field.width()));
      next += std::ptrdiff_t(field.width());
    }
  }
  ASSERT_EQ(simulation.collisions(), 0u);
  const std::size_t whole = 9 + 4 * 2 + 3;  // 64 samples
  const double time = 3.2;
  double p1 = 0, v2 = 0, w2 = 0, along = 0, parallel = 0, perpendicular = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Vector &v = start.velocity[i], &w = start.angular_velocity[i], &u = start.orientation[i];
    const double speed = std::sqrt(dot(w, w)), c = std::cos(speed * time),
                 s = std::sin(speed * time);
    const Vector across{(w[1] * u[2] - w[2] * u[1]) / speed, (w[2] * u[0] - w[0] * u[2]) / speed,
                        (w[0] * u[1] - w[1] * u[0]) / speed};
    const double vu = dot(v, u), vu_now = vu * c + dot(v, across) * s;
    p1 += c, v2 += dot(v, v), w2 += dot(w, w), along += vu * vu_now;
    parallel += vu * vu * time * time;
    perpendicular += (dot(v, v) - vu * vu) * time * time;
  }
  const double count = 300;
  EXPECT_NEAR(values["lag"][whole], time, 1e-12);
  EXPECT_NEAR(values["p1"][whole], p1 / count, 1e-9);
  EXPECT_NEAR(values["velocity"][whole], v2 / count, 1e-12);
  EXPECT_NEAR(values["angular_velocity"][whole], w2 / count, 1e-9);
  EXPECT_NEAR(values["velocity_parallel"][whole], along / count, 1e-9);
  EXPECT_NEAR(values["parallel"][whole], parallel / count, 1e-8);
  EXPECT_NEAR(values["perpendicular"][whole], perpendicular / count, 1e-8);
}

// Law: <v(0).v(t)> and <w(0).w(t)> of elastic needles fall at the exact rates of
// theory::uncorrelated_transport at first, at every density. The curvature of a short time drops
// out of two of them. Tolerance: 3 standard errors of runs with different seeds.
TEST(TimeCorrelation, FallsAtTheExactRateAtFirst) {
  for (const double density : {1.0, 30.0}) {
    const std::size_t count = 500;
    const double edge = std::cbrt(double(count) / density);
    Scene scene = scene_with("time_correlation", count, {edge, edge, edge});
    const theory::Transport exact =
        theory::uncorrelated_transport((count - 1.0) / std::pow(edge, 3), 1, 6);
    const double step = 0.03 / exact.angular_velocity_decay;
    test::Mean velocity, angular_velocity;
    for (int run = 0; run < 12; ++run, ++scene.needles.seed) {
      Observation observation(scene);
      Simulation simulation(scene);
      const std::vector<SeriesField> fields = observation.groups().back().fields;
      std::map<std::string, std::array<double, 3>> sums;
      const int samples = density > 10 ? 300 : 150;
      for (int now = 0; now < samples; ++now) {
        Scene::Until until;
        until.time = step * now;
        if (now > 0) simulation.advance(until);
        const auto row = observation.sample(simulation.copy(), simulation.totals());
        auto next = row.begin();
        for (const SeriesField& field : fields) {
          if (field.kind == SeriesField::Kind::constant) continue;
          for (std::size_t n = 0; n < 3 && now >= 2; ++n) sums[field.name][n] += *(next + long(n));
          next += std::ptrdiff_t(field.width());
        }
      }
      const auto rate = [&](const char* name) {
        const auto& [c0, c1, c2] = sums[name];
        return (1.5 * c0 - 2 * c1 + 0.5 * c2) / c0 / step;
      };
      velocity.add(rate("velocity"));
      angular_velocity.add(rate("angular_velocity"));
    }
    for (const auto& [mean, expected] :
         {std::pair{velocity.measured(), exact.velocity_decay},
          {angular_velocity.measured(), exact.angular_velocity_decay}}) {
      EXPECT_NEAR(mean.value, expected, 3 * mean.error) << "n = " << density;
      EXPECT_LT(mean.error, 0.05 * expected);
    }
  }
}

}  // namespace
}  // namespace needlework::observe
