#include "src/runs/exact_rates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "needlework/theory.h"
#include "src/scene/confinement.h"

namespace needlework::runs {
namespace {

// By how much needles of two species collide more often between walls than in a periodic box of
// this volume, where nothing is known of positions and directors but that both tips are inside.
// None where it is not known exactly.
std::optional<double> factor_between_walls(const Scene& scene, const Species& a,
                                           theory::Temperatures at_a, const Species& b,
                                           theory::Temperatures at_b) {
  if (scene.walls.empty()) return 1;
  if (a.diameter > 0 || b.diameter > 0) return {};
  double factor = 1;
  int walled = 0;
  const std::array<Gap, 3> gaps = gaps_of(scene);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!gaps[axis].is_walled()) continue;
    if (++walled > 1 || gaps[axis].is_open()) return {};
    const double edge = scene.needles.box[axis], gap = edge + gaps[axis].high - gaps[axis].low;
    factor = edge / gap * theory::pair_factor_between_walls(a, at_a, b, at_b, gap);
  }
  return factor;
}

// Multiplies the rates of each two species by that factor; false if one of them is not known.
bool put_between_walls(const Scene& scene, const std::vector<theory::Temperatures>& now,
                       std::vector<double>& rates) {
  const Composition composition = scene.composition();
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      double& rate = rates[composition.pair_index(a, b)];
      if (!(rate > 0)) continue;
      const auto factor =
          factor_between_walls(scene, composition[a], now[a], composition[b], now[b]);
      if (!factor) return false;
      rate *= *factor;
    }
  }
  return true;
}

// Of how many axes the momentum is conserved: hits on walls change it along theirs.
int conserved_momenta(const Scene& scene) {
  const std::array<bool, 3> periodic = scene.periodic();
  return static_cast<int>(std::ranges::count(periodic, true));
}

// Whether nothing changes the distribution of velocities at this temperature: thermal walls and the
// thermostat have it, and other walls are elastic and at rest.
bool stays_at_temperature(const Scene& scene, double t) {
  const auto leaves_it = [&](const Scene::Wall& wall) {
    return !wall.motion && (wall.temperature ? *wall.temperature == t : wall.epsilon == 1);
  };
  const Scene::Driving& driving = scene.driving;
  return !has_gravity(scene) && !driving.kicks &&
         !(driving.andersen && driving.andersen->temperature != t) &&
         std::ranges::all_of(scene.walls, leaves_it);
}

// Of a gas that starts in equilibrium.
theory::Temperatures temperatures_of(const Scene& scene) {
  const double t = scene.composition()[0].t_tr;
  return {t, t};
}

// Those of each two species at the start, were there so many needles of each.
std::vector<double> initial_rates_of(const LoadedScene& loaded, const Composition& counts) {
  const Scene& scene = loaded.scene;
  const auto start = temperatures_by_species(loaded);
  const std::vector<double> open =
      theory::mixture_rates(counts, volume_of(scene), start).collisions;
  std::vector<double> rates = open;
  return !loaded.initial && put_between_walls(scene, start, rates) ? rates : open;
}

// Species that do not meet may each keep an energy of their own.
bool has_exact_equilibrium(const Scene& scene) {
  const Composition composition = scene.composition();
  return starts_in_equilibrium(scene) && !composition.has_width() && composition.all_meet();
}

}  // namespace

std::vector<double> initial_rates_by_pair(const LoadedScene& loaded) {
  return initial_rates_of(loaded, loaded.scene.composition());
}

std::vector<double> counted_rates_by_pair(const LoadedScene& loaded) {
  const Composition composition = loaded.scene.composition();
  if (composition.has_width()) return initial_rates_by_pair(loaded);
  Composition paired = composition;  // with a rate of each species with itself
  for (std::size_t n = 0; n < composition.size(); ++n) {
    if (composition[n].count == 1) paired.set_count(n, 2);
  }
  std::vector<double> rates = initial_rates_of(loaded, paired);
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const auto pairs = [&](const Composition& of, double self) {
        return static_cast<double>(of[a].count) * (static_cast<double>(of[b].count) - self);
      };
      const double known = pairs(paired, a == b ? 1 : 0);
      if (known > 0) rates[composition.pair_index(a, b)] *= pairs(composition, 0) / known;
    }
  }
  return rates;
}

double initial_collision_rate(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  const Composition composition = scene.composition();
  if (composition.is_needle_gas()) {
    const theory::Temperatures start = initial_temperatures(loaded);
    const Species& all = composition[0];
    const double factor =
        loaded.initial ? 1 : factor_between_walls(scene, all, start, all, start).value_or(1);
    return factor * theory::collision_rate(theory_density_of(scene), start, all.k);
  }
  const std::vector<double> rates = counted_rates_by_pair(loaded);
  const double all = std::accumulate(rates.begin(), rates.end(), 0.0);
  return 2 * all / static_cast<double>(composition.count());
}

bool starts_in_equilibrium(const Scene& scene) {
  const Composition composition = scene.composition();
  const double t = composition[0].t_tr;
  return !composition.is_inelastic() && stays_at_temperature(scene, t) &&
         scene.initial.file.empty() && t > 0 &&
         std::ranges::all_of(composition.species(),
                             [&](const Species& s) { return s.t_tr == t && s.t_rot == t; }) &&
         composition.count() >= 2;
}

std::vector<double> equilibrium_rates_by_pair(const Scene& scene, double energy) {
  if (!has_exact_equilibrium(scene)) return {};
  const Composition composition = scene.composition();
  // Those of all species are the same, and for the factor only their ratios count.
  const std::vector<theory::Temperatures> same(composition.size(), temperatures_of(scene));
  std::vector<double> rates =
      exchanges_energy(scene)
          ? theory::mixture_rates(composition, volume_of(scene), same).collisions
          : theory::mixture_equilibrium_rates(composition, volume_of(scene),
                                              static_cast<double>(scene.needles.count) * energy,
                                              conserved_momenta(scene));
  if (!put_between_walls(scene, same, rates)) return {};
  return rates;
}

double equilibrium_rate(const Scene& scene, double energy) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (!has_exact_equilibrium(scene)) return unknown;
  const double count = static_cast<double>(scene.needles.count);
  const Composition composition = scene.composition();
  if (composition.is_mixture()) {
    const std::vector<double> rates = equilibrium_rates_by_pair(scene, energy);
    if (rates.empty()) return unknown;
    return 2 * std::accumulate(rates.begin(), rates.end(), 0.0) / count;
  }
  const Species& species = composition[0];
  const auto factor = factor_between_walls(scene, species, {1, 1}, species, {1, 1});
  if (!factor) return unknown;
  const double cube = species.length * species.length * species.length;
  const double volume = volume_of(scene) / cube;
  const double rate =
      exchanges_energy(scene)
          ? theory::collision_rate((count - 1) / volume, temperatures_of(scene), species.k)
          : theory::equilibrium_rate(count, volume, count * energy, species.k,
                                     conserved_momenta(scene));
  return *factor * rate / (species.length * std::sqrt(species.mass));
}

}  // namespace needlework::runs
