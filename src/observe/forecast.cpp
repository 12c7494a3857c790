#include "src/observe/forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace needlework {
namespace {

// The theory's cooling curve on a logarithmic grid of times, to be inverted.
struct Curve {
  std::vector<double> time, collisions, energy_ratio;

  // Times from 1e-4 to 1e20 units on, but not beyond the end.
  Curve(double unit, double end) {
    constexpr int per_decade = 20;
    for (int n = -4 * per_decade; n <= 20 * per_decade; ++n) {
      const double next = unit * std::pow(10.0, double(n) / per_decade);
      if (next >= end) break;
      time.push_back(next);
    }
    if (std::isfinite(end)) time.push_back(end);
  }

  Forecast at(std::size_t i, Stop stop) const {
    return {stop, time[i], collisions[i], energy_ratio[i]};
  }

  // Interpolates between points i - 1 and i by powers of time. Before the first point, collisions
  // are proportional to time.
  Forecast between(std::size_t i, double weight, Stop stop) const {
    const auto mix = [&](const std::vector<double>& of, double start) {
      if (i == 0) return start + weight * (of[0] - start);
      return std::exp(std::lerp(std::log(of[i - 1]), std::log(of[i]), weight));
    };
    return {stop, mix(time, 0), mix(collisions, 0), mix(energy_ratio, 1)};
  }
};

// Where the curve ends, a gas that cools follows Haff's law: E ~ t^-2, and the collisions grow
// with log t. The time is infinite where a double cannot hold it.
std::optional<Forecast> beyond(const Curve& curve, const Scene::Until& until) {
  if (curve.time.size() < 2) return std::nullopt;
  const std::size_t last = curve.time.size() - 1;
  const double per_log = (curve.collisions[last] - curve.collisions[last - 1]) /
                         std::log(curve.time[last] / curve.time[last - 1]);
  constexpr double never = std::numeric_limits<double>::infinity();
  const double to_collisions =
      until.collisions_per_needle
          ? (*until.collisions_per_needle - curve.collisions[last]) / per_log
          : never;
  const double to_energy =
      until.energy_ratio ? 0.5 * std::log(curve.energy_ratio[last] / *until.energy_ratio) : never;
  const double growth = std::min(to_collisions, to_energy);  // of log t
  if (growth == never) return std::nullopt;
  return Forecast{growth == to_energy ? Stop::energy : Stop::collisions,
                  curve.time[last] * std::exp(growth), curve.collisions[last] + per_log * growth,
                  curve.energy_ratio[last] * std::exp(-2 * growth)};
}

// The interpolation weight of `target` between two values: logarithmic, but linear for i = 0,
// which is the start.
double weight_of(double target, double before, double after) {
  if (before > 0) return std::log(target / before) / std::log(after / before);
  return target / after;
}

// Where a gas that moves meets the first condition on its curve.
std::optional<Forecast> on_curve(const Curve& curve, const Scene::Until& until, bool cools) {
  for (std::size_t i = 0; i < curve.time.size(); ++i) {
    const double collisions_before = i > 0 ? curve.collisions[i - 1] : 0;
    if (until.collisions_per_needle && curve.collisions[i] >= *until.collisions_per_needle) {
      const double weight =
          weight_of(*until.collisions_per_needle, collisions_before, curve.collisions[i]);
      return curve.between(i, weight, Stop::collisions);
    }
    if (until.energy_ratio && curve.energy_ratio[i] <= *until.energy_ratio) {
      const double before = i > 0 ? curve.energy_ratio[i - 1] : 1;
      const double weight = weight_of(*until.energy_ratio, before, curve.energy_ratio[i]);
      return curve.between(i, weight, Stop::energy);
    }
  }
  if (until.time) return curve.at(curve.time.size() - 1, Stop::time);
  return cools ? beyond(curve, until) : std::nullopt;
}

double end_of(const Scene::Until& until) {
  return until.time.value_or(std::numeric_limits<double>::infinity());
}

// Of a gas in which nothing happens.
std::optional<Forecast> at_rest(const Scene::Until& until) {
  if (!until.time) return std::nullopt;
  return Forecast{.stop = Stop::time, .time = *until.time};
}

}  // namespace

std::optional<Forecast> forecast_at_rate(double rate, const Scene::Until& until) {
  if (until.energy_ratio && *until.energy_ratio >= 1) return Forecast{.stop = Stop::energy};
  if (!(rate > 0)) return at_rest(until);
  const double to_collisions = until.collisions_per_needle
                                   ? *until.collisions_per_needle / rate
                                   : std::numeric_limits<double>::infinity();
  if (end_of(until) <= to_collisions) {
    if (!until.time) return std::nullopt;
    return Forecast{
        .stop = Stop::time, .time = *until.time, .collisions_per_needle = rate * *until.time};
  }
  return Forecast{.stop = Stop::collisions,
                  .time = to_collisions,
                  .collisions_per_needle = *until.collisions_per_needle};
}

double theory_time_scale(double density) {
  return 2.0 / 3.0 * std::sqrt(std::numbers::pi) * density;
}

std::optional<Forecast> forecast(const theory::Gas& gas, theory::Temperatures initial,
                                 double density, const Scene::Until& until) {
  if (until.energy_ratio && *until.energy_ratio >= 1) return Forecast{.stop = Stop::energy};
  if (!(initial.energy() > 0 && density > 0)) return at_rest(until);
  const double scale = theory_time_scale(density);
  Curve curve(1 / (std::sqrt(initial.energy()) * scale), end_of(until));
  std::vector<double> taus = curve.time;
  for (double& tau : taus) tau *= scale;
  curve.collisions = theory::collisions_per_needle(gas, initial, taus);
  for (const auto& now : theory::cooling_curve(gas, initial, taus)) {
    curve.energy_ratio.push_back(now.energy() / initial.energy());
  }
  return on_curve(curve, until, !std::isnan(theory::asymptotic_ratio(gas)));
}

std::optional<Forecast> forecast(const Composition& composition, double volume,
                                 const std::vector<theory::Temperatures>& initial,
                                 const Scene::Until& until) {
  if (until.energy_ratio && *until.energy_ratio >= 1) return Forecast{.stop = Stop::energy};
  const auto rates = theory::mixture_rates(composition, volume, initial).collisions;
  // No theory says how often rods are in contact of which some pass through each other.
  if (composition.has_width() && !composition.all_meet()) return std::nullopt;
  const std::vector<double> contact = theory::contact_values(composition, volume);
  const double rate = std::inner_product(rates.begin(), rates.end(), contact.begin(), 0.0);
  if (!(rate > 0)) return at_rest(until);
  Curve curve(static_cast<double>(composition.count()) / rate, end_of(until));
  const double energy = theory::mean_of_species(composition, initial).energy();
  theory::MixtureCurve course(composition, volume, initial, contact);
  for (const double time : curve.time) {
    const double now = theory::mean_of_species(composition, course.at(time)).energy();
    // Theory gives up where ratios of temperatures take too long to relax.
    if (!std::isfinite(now)) break;
    curve.collisions.push_back(course.collisions_per_needle());
    curve.energy_ratio.push_back(now / energy);
  }
  const bool followed = curve.collisions.size() == curve.time.size();
  curve.time.resize(curve.collisions.size());
  Scene::Until on_it = until;
  if (!followed) on_it.time.reset();
  return on_curve(curve, on_it, composition.is_inelastic());
}

}  // namespace needlework
