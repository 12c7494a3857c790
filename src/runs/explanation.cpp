#include "src/runs/explanation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "src/calendar/choice.h"
#include "src/runs/engine_choice.h"
#include "src/runs/estimates.h"
#include "src/runs/exact_rates.h"
#include "src/scene/accuracy.h"
#include "src/scene/check.h"
#include "src/scene/confinement.h"
#include "src/scene/needed_memory.h"
#include "src/search/choice.h"

namespace needlework::runs {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

double collisions_of(const std::optional<Forecast>& expected, const Scene& scene) {
  if (!expected) return undefined;
  return 0.5 * expected->collisions_per_needle * static_cast<double>(scene.needles.count);
}

// At which equal needles in a periodic box collide as often as those of the scene, which may be
// between walls.
double density_of_theory(const LoadedScene& loaded) {
  const double density = theory_density_of(loaded.scene);
  const double rate = theory::collision_rate(density, initial_temperatures(loaded),
                                             loaded.scene.composition()[0].k);
  return rate > 0 ? density * (initial_collision_rate(loaded) / rate) : density;
}

// Of a gas that keeps its energy, and collides as often as at the start.
std::optional<Forecast> at_rate_of_start(const LoadedScene& loaded) {
  const Composition composition = loaded.scene.composition();
  if (composition.is_inelastic()) return std::nullopt;
  const std::vector<double> rates = initial_contacts_by_pair(loaded);
  const double all = std::accumulate(rates.begin(), rates.end(), 0.0);
  return forecast_at_rate(2 * all / static_cast<double>(composition.count()), loaded.scene.until);
}

// Of one species, or of a mixture that theory follows.
std::optional<Forecast> expected_of(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  const Composition composition = scene.composition();
  if (is_pushed(scene)) return std::nullopt;
  if (beyond_cooling_theory(composition)) return at_rate_of_start(loaded);
  if (composition.is_needle_gas()) {
    const Restitution& rule = composition.restitution(0, 0);
    return forecast({composition[0].k, rule.epsilon, rule.beta}, initial_temperatures(loaded),
                    density_of_theory(loaded), scene.until);
  }
  if (!has_mixture_theory(composition)) return std::nullopt;
  return forecast(composition, volume_of(scene), temperatures_by_species(loaded), scene.until);
}

// What `count` alike bodies do to walls.
struct Hitting {
  Species body;
  double count;
  theory::Temperatures now;
};

// All of them; nothing where they are more than it is worth to ask for.
std::vector<Hitting> hitting_walls(const LoadedScene& loaded) {
  constexpr std::size_t most = 20000;
  const Composition composition = loaded.scene.composition();
  const auto now = temperatures_by_species(loaded);
  std::vector<Hitting> out;
  for (std::size_t n = 0; n < composition.size(); ++n) {
    const Species& each = composition[n];
    if (each.fixed || each.sizes) continue;
    out.push_back({each, static_cast<double>(each.count), now[n]});
  }
  if (!composition.has_own_sizes()) return out;
  const Members members = members_of(loaded);
  if (members.size() > most) return {};
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Species& its = members.species_of(i);
    if (its.fixed || !its.sizes) continue;
    const BodyNumbers body = members.body(i);
    Species alone{.length = body.length, .mass = body.mass, .diameter = body.diameter};
    if (alone.has_axis()) alone.k = k_of(body.mass, body.length, body.inertia);
    out.push_back({std::move(alone), 1, now[members.species[i]]});
  }
  return out;
}

// When a wall with a velocity comes to rest; NaN where it does not.
double stop_of(const std::optional<MovingEdges>& moving, const Scene::WallSide& side) {
  if (!moving) return undefined;
  const double halt = to_double(moving->of(side.axis, side.is_high).halt_time());
  return std::isfinite(halt) ? halt : undefined;
}

// How fast a wall comes towards the gas. [L / time]
double advance_of(const Scene& scene, const Scene::WallSide& side) {
  const auto& motion = scene.walls[side.entry].motion;
  const double velocity = motion ? motion->velocity.value_or(0) : 0;
  return side.is_high ? -velocity : velocity;
}

std::optional<ExplainedMotion> motion_of(const Scene& scene) {
  const auto moving = moving_edges_of(scene, scene.needles.box);
  if (!moving) return {};
  ExplainedMotion out{.meeting = meeting_of(scene, scene.needles.box), .time = undefined};
  if (out.meeting) out.time = out.meeting->time;
  if (const auto& end = scene.until.time) out.time = std::fmin(out.time, *end);
  if (std::isnan(out.time)) {
    // A wall that never stops leaves no last moment.
    out.time = 0;
    for (const Scene::WallSide& side : scene.wall_sides()) {
      if (advance_of(scene, side) == 0) continue;
      const double stop = stop_of(moving, side);
      if (std::isnan(stop))
        return ExplainedMotion{.meeting = {}, .time = undefined, .volume = undefined};
      out.time = std::max(out.time, stop);
    }
  }
  const Vector edges = moving->distances(out.time);
  out.volume = edges[0] * edges[1] * edges[2];
  return out;
}

// Exact where no gravity acts, for walls that do not shake and a state that is drawn.
std::vector<ExplainedWall> walls_of(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  const std::vector<Hitting> bodies =
      scene.walls.empty() ? std::vector<Hitting>() : hitting_walls(loaded);
  std::array<bool, 3> walled{};
  bool is_known =
      !bodies.empty() && !loaded.initial && scene.forces.gravity == std::array<double, 3>{};
  for (const Scene::Wall& wall : scene.walls) is_known = is_known && !shakes(wall);
  const auto moving = moving_edges_of(scene, scene.needles.box);
  std::vector<ExplainedWall> out;
  for (const Scene::WallSide& side : scene.wall_sides()) {
    walled[side.axis] = true;
    const double start = is_known ? 0 : undefined;
    out.push_back({side, start, scene.walls[side.entry].temperature ? undefined : start,
                   stop_of(moving, side)});
  }
  if (!is_known || out.empty()) return out;
  for (const auto& [body, count, now] : bodies) {
    // The caps of rods touch walls where the ends of their axes are half a diameter away.
    std::array<double, 3> room = scene.needles.box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (walled[axis]) room[axis] -= body.diameter;
    }
    const auto resting = theory::wall_rates(body, room, walled, now);
    for (ExplainedWall& wall : out) {
      const double advance = advance_of(scene, wall.side);
      const auto rates =
          advance == 0 ? resting : theory::wall_rates(body, room, walled, now, advance);
      const double epsilon = scene.walls[wall.side.entry].epsilon;
      wall.hits += count * rates[wall.side.axis].hits;
      wall.force += count * 0.5 * (1 + epsilon) * rates[wall.side.axis].force;
    }
  }
  return out;
}

std::vector<ExplainedGravity> gravity_of(const LoadedScene& loaded) {
  const Composition composition = loaded.scene.composition();
  const theory::Temperatures start = initial_temperatures(loaded);
  const double temperature = 2 * start.energy() / (3 + 2 * start.turning);
  const std::array<bool, 3> periodic = loaded.scene.periodic();
  std::vector<ExplainedGravity> out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double pull = std::abs(loaded.scene.forces.gravity[axis]);
    if (pull == 0) continue;
    ExplainedGravity& along = out.emplace_back(ExplainedGravity{.axis = axis});
    for (const Species& each : composition.species()) {
      along.weight += static_cast<double>(each.count) * each.mass * pull;
      if (!periodic[axis]) along.scale_heights.push_back(temperature / (each.mass * pull));
    }
  }
  return out;
}

double kick_power_of(const Scene& scene) {
  const auto& kicks = scene.driving.kicks;
  if (!kicks) return 0;
  return theory::kick_power(scene.composition(), kicks->translational, kicks->rotational);
}

std::optional<theory::SteadyShear> steady_of(const Scene& scene) {
  const Composition composition = scene.composition();
  const std::optional<std::size_t> only = composition.only();
  if (!scene.shear || !scene.walls.empty() || scene.driving.kicks || scene.driving.andersen ||
      !only || composition.has_own_sizes())
    return {};
  const Restitution& rule = composition.restitution(*only, *only);
  if (rule.is_rough()) return {};
  const double density = static_cast<double>(composition.count()) / volume_of(scene);
  return theory::steady_shear(composition[*only], rule.epsilon, density, scene.shear->rate);
}

std::optional<PlannedPlacement> placing_of(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  if (loaded.initial || scene.needles.count == 0 || !scene.composition().has_width()) return {};
  return plan_placement(scene);
}

std::vector<double> rates_of(const LoadedScene& loaded) {
  const Composition composition = loaded.scene.composition();
  if (!has_mixture_theory(composition)) return {};
  return initial_rates_by_pair(loaded);
}

// Of a mixture of no needles the rate is not a number.
double mean_free_time_of(double rate) {
  return rate > 0 ? 1 / rate : std::numeric_limits<double>::infinity();
}

}  // namespace

Explanation::Explanation(const LoadedScene& loaded)
    : scene(loaded.scene),
      density(density_of(scene)),
      initial(initial_temperatures(loaded)),
      by_species(temperatures_by_species(loaded)),
      mean_free_time(mean_free_time_of(initial_collision_rate(loaded))),
      rate_exact(equilibrium_rate(scene, initial.energy())),
      rates(rates_of(loaded)),
      counted_rates(rates.empty() ? rates : counted_rates_by_pair(loaded)),
      walls(walls_of(loaded)),
      motion(motion_of(scene)),
      gravity(gravity_of(loaded)),
      kick_power(kick_power_of(scene)),
      steady(steady_of(scene)),
      expected(expected_of(loaded)),
      collisions(collisions_of(expected, scene)),
      placing(placing_of(loaded)),
      placing_seconds(placing ? estimated_placing_seconds(scene, density, *placing) : 0),
      seconds(expected && std::isfinite(expected->time)
                  ? placing_seconds + estimated_setup_seconds(scene, density) +
                        collisions * estimated_seconds_per_collision(scene, density)
                  : undefined),
      memory(estimated_memory(scene)),
      search(chosen_search(scene.engine.search, density, scene.composition(),
                           scene.shear.has_value())),
      calendar(chosen_calendar(scene.engine.queue, scene.engine.threads.value_or(1))),
      accuracy(accuracy_name(scene.engine)),
      isa(resolved_isa(scene.engine)),
      threads(scene.engine.threads.value_or(1)),
      warnings(all_warnings(loaded)) {}

}  // namespace needlework::runs
