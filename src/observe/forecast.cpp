#include "src/observe/forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace needlework {
namespace {

// The theory's cooling curve on a logarithmic grid of tau, to be inverted.
struct Curve {
  std::vector<double> tau, collisions, energy_ratio;

  Curve(const theory::Gas& gas, theory::Temperatures initial, double end) {
    constexpr int per_decade = 20;
    const double unit = 1 / std::sqrt(initial.energy());
    for (int n = -4 * per_decade; n <= 20 * per_decade; ++n) {
      const double next = unit * std::pow(10.0, double(n) / per_decade);
      if (next >= end) break;
      tau.push_back(next);
    }
    if (std::isfinite(end)) tau.push_back(end);
    collisions = theory::collisions_per_needle(gas, initial, tau);
    for (const auto& now : theory::cooling_curve(gas, initial, tau)) {
      energy_ratio.push_back(now.energy() / initial.energy());
    }
  }

  Forecast at(std::size_t i, Stop stop) const {
    return {stop, tau[i], collisions[i], energy_ratio[i]};
  }

  // Interpolates between points i - 1 and i by powers of tau. Before the first point, collisions
  // are proportional to tau.
  Forecast between(std::size_t i, double weight, Stop stop) const {
    const auto mix = [&](const std::vector<double>& of, double start) {
      if (i == 0) return start + weight * (of[0] - start);
      return std::exp(std::lerp(std::log(of[i - 1]), std::log(of[i]), weight));
    };
    return {stop, mix(tau, 0), mix(collisions, 0), mix(energy_ratio, 1)};
  }
};

// Where the curve ends, a gas that cools follows Haff's law: E ~ tau^-2, and the collisions grow
// with log tau. The time is infinite where a double cannot hold it.
std::optional<Forecast> beyond(const Curve& curve, const Scene::Until& until) {
  const std::size_t last = curve.tau.size() - 1;
  const double per_log = (curve.collisions[last] - curve.collisions[last - 1]) /
                         std::log(curve.tau[last] / curve.tau[last - 1]);
  constexpr double never = std::numeric_limits<double>::infinity();
  const double to_collisions =
      until.collisions_per_needle
          ? (*until.collisions_per_needle - curve.collisions[last]) / per_log
          : never;
  const double to_energy =
      until.energy_ratio ? 0.5 * std::log(curve.energy_ratio[last] / *until.energy_ratio) : never;
  const double growth = std::min(to_collisions, to_energy);  // of log tau
  if (growth == never) return std::nullopt;
  return Forecast{growth == to_energy ? Stop::energy : Stop::collisions,
                  curve.tau[last] * std::exp(growth), curve.collisions[last] + per_log * growth,
                  curve.energy_ratio[last] * std::exp(-2 * growth)};
}

// The interpolation weight of `target` between two values: logarithmic, but linear for i = 0,
// which is the start.
double weight_of(double target, double before, double after) {
  if (before > 0) return std::log(target / before) / std::log(after / before);
  return target / after;
}

}  // namespace

double theory_time_scale(double density) {
  return 2.0 / 3.0 * std::sqrt(std::numbers::pi) * density;
}

std::optional<Forecast> forecast(const theory::Gas& gas, theory::Temperatures initial,
                                 double density, const Scene::Until& until) {
  const double scale = theory_time_scale(density);
  const bool moves = initial.energy() > 0 && density > 0;
  if (until.energy_ratio && *until.energy_ratio >= 1) return Forecast{.stop = Stop::energy};
  if (!moves) {
    if (!until.time) return std::nullopt;
    return Forecast{.stop = Stop::time, .time = *until.time};
  }

  const double end = until.time ? *until.time * scale : std::numeric_limits<double>::infinity();
  const Curve curve(gas, initial, end);
  const auto in_units_of_the_scene = [&](Forecast result) {
    result.time /= scale;
    return result;
  };
  for (std::size_t i = 0; i < curve.tau.size(); ++i) {
    const double collisions_before = i > 0 ? curve.collisions[i - 1] : 0;
    if (until.collisions_per_needle && curve.collisions[i] >= *until.collisions_per_needle) {
      const double weight =
          weight_of(*until.collisions_per_needle, collisions_before, curve.collisions[i]);
      return in_units_of_the_scene(curve.between(i, weight, Stop::collisions));
    }
    if (until.energy_ratio && curve.energy_ratio[i] <= *until.energy_ratio) {
      const double before = i > 0 ? curve.energy_ratio[i - 1] : 1;
      const double weight = weight_of(*until.energy_ratio, before, curve.energy_ratio[i]);
      return in_units_of_the_scene(curve.between(i, weight, Stop::energy));
    }
  }
  if (!until.time) {
    const bool cools = !std::isnan(theory::asymptotic_ratio(gas));
    const auto result = cools ? beyond(curve, until) : std::nullopt;
    return result ? std::optional(in_units_of_the_scene(*result)) : std::nullopt;
  }
  return in_units_of_the_scene(curve.at(curve.tau.size() - 1, Stop::time));
}

}  // namespace needlework
