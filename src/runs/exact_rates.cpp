#include "src/runs/exact_rates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "needlework/body_rates.h"
#include "needlework/initial_state.h"
#include "needlework/theory.h"
#include "src/machine/stop_request.h"
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

// Of how many axes the momentum is conserved: hits on walls change it along theirs, those on fixed
// bodies along all.
int conserved_momenta(const Scene& scene) {
  if (scene.composition().has_fixed()) return 0;
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
  return !has_gravity(scene) && !driving.kicks && !driving.growth &&
         !(driving.andersen && driving.andersen->temperature != t) &&
         std::ranges::all_of(scene.walls, leaves_it);
}

// Of the needles that move, in a gas that starts in equilibrium.
double temperature_of(const Composition& composition) {
  const auto moves = [](const Species& each) { return !each.fixed; };
  return std::ranges::find_if(composition.species(), moves)->t_tr;
}

// The same of each species: fixed ones are at rest.
std::vector<theory::Temperatures> at_temperature(const Composition& composition, double t) {
  std::vector<theory::Temperatures> out;
  for (const Species& each : composition.species()) {
    const double its = each.fixed ? 0 : t;
    out.push_back({its, its});
  }
  return out;
}

theory::Body body_of(const BodyNumbers& numbers, theory::Temperatures now) {
  return {numbers.length, numbers.diameter, numbers.mass, numbers.inertia, now};
}

theory::BodyRates body_rates_of(const Members& members,
                                const std::vector<theory::Temperatures>& now) {
  theory::BodyRates out(members.composition);
  for (std::size_t i = 0; i < members.size(); ++i) {
    StopRequest::check_in_turn(i);
    out.add(members.species[i], body_of(members.body(i), now[members.species[i]]));
  }
  return out;
}

// By the means of each species, were there so many needles of each.
std::vector<double> rates_by_means(const LoadedScene& loaded, const Composition& counts,
                                   const std::vector<theory::Temperatures>& now) {
  return theory::mixture_rates(counts, volume_of(loaded.scene), now).collisions;
}

// Of these rates at the start, where walls make more of them.
std::vector<double> between_walls(const LoadedScene& loaded, const std::vector<double>& open,
                                  const std::vector<theory::Temperatures>& start) {
  std::vector<double> rates = open;
  return !loaded.initial && put_between_walls(loaded.scene, start, rates) ? rates : open;
}

// Among whom the energy of elastic needles is shared in the course of time.
enum class Sharing { with_bath, all_that_move, none, unknown };

Sharing sharing_of(const Scene& scene) {
  if (exchanges_energy(scene)) return Sharing::with_bath;
  const Composition composition = scene.composition();
  bool all_meet = true, any_meet = false, any_hits_fixed = false;
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const Species &first = composition[a], &second = composition[b];
      const std::uint64_t others = second.count - (a == b && second.count > 0 ? 1 : 0);
      if (first.count == 0 || others == 0 || (first.fixed && second.fixed)) continue;
      const bool meet = composition.meets(a, b);
      if (first.fixed || second.fixed) {
        any_hits_fixed |= meet;
      } else {
        all_meet &= meet;
        any_meet |= meet;
      }
    }
  }
  // Those that meet fixed bodies alone keep what they have.
  if (!any_meet && any_hits_fixed) return Sharing::none;
  if (all_meet && (any_hits_fixed || !composition.has_fixed())) return Sharing::all_that_move;
  return Sharing::unknown;
}

// Whether bodies that differ are known from the scene alone.
bool has_known_bodies(const Scene& scene) {
  return std::ranges::all_of(
      scene.species, [](const Species& each) { return !each.sizes || each.drawn != DrawnSizes{}; });
}

// Of needles of which each keeps its energy E: its velocities lie on a sphere in 5 dimensions, as
// those of temperature 2 E / 5 do whose speeds are larger by a factor.
std::vector<double> rates_at_own_energies(const Scene& scene) {
  const State start = draw_initial_state(scene);
  const Members members = members_of(scene.composition(), start);
  theory::BodyRates out(members.composition);
  const auto square = [](const std::array<double, 3>& a) {
    return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
  };
  for (std::size_t i = 0; i < members.size(); ++i) {
    const BodyNumbers body = members.body(i);
    double t = 0;
    if (!members.species_of(i).fixed) {
      const double energy = 0.5 * (body.mass * square(start.velocity[i]) +
                                   body.inertia * square(start.angular_velocity[i]));
      const auto [temperature, speed] = theory::equilibrium_of(1, energy, 0);
      t = temperature * (speed * speed);
    }
    out.add(members.species[i], body_of(body, {t, t}));
  }
  return out.collisions(volume_of(scene));
}

// In a periodic box; empty where they are not known.
std::vector<double> open_equilibrium_rates(const Scene& scene, double energy) {
  const Composition composition = scene.composition();
  const double volume = volume_of(scene), t = temperature_of(composition);
  const double moving = static_cast<double>(composition.count() - composition.fixed());
  const bool differ = composition.has_own_sizes();
  const auto of_bodies = [&](double temperature) {
    return body_rates_of(drawn_members(scene), at_temperature(composition, temperature))
        .collisions(volume);
  };
  switch (sharing_of(scene)) {
    case Sharing::with_bath:
      if (differ) return of_bodies(t);
      return theory::mixture_rates(composition, volume, at_temperature(composition, t)).collisions;
    case Sharing::all_that_move: {
      const int conserved = conserved_momenta(scene);
      if (!differ)
        return theory::mixture_equilibrium_rates(composition, volume, moving * energy, conserved);
      const auto [temperature, speed] = theory::equilibrium_of(moving, moving * energy, conserved);
      std::vector<double> out = of_bodies(temperature);
      for (double& rate : out) rate *= speed;
      return out;
    }
    case Sharing::none:
      return rates_at_own_energies(scene);
    case Sharing::unknown:
      break;
  }
  return {};
}

}  // namespace

std::vector<double> initial_rates_by_pair(const LoadedScene& loaded) {
  const Composition composition = loaded.scene.composition();
  const auto start = temperatures_by_species(loaded);
  const std::vector<double> open =
      composition.has_own_sizes()
          ? body_rates_of(members_of(loaded), start).collisions(volume_of(loaded.scene))
          : rates_by_means(loaded, composition, start);
  return between_walls(loaded, open, start);
}

std::vector<double> initial_contacts_by_pair(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  const Composition composition = scene.composition();
  if (!composition.has_width()) return initial_rates_by_pair(loaded);
  const double volume = volume_of(scene);
  if (composition.has_own_sizes() && composition.are_spheres()) {
    const auto start = temperatures_by_species(loaded);
    return body_rates_of(members_of(loaded), start).collisions_of_spheres(volume);
  }
  std::vector<double> out = initial_rates_by_pair(loaded);
  const std::vector<double> contact = theory::contact_values(composition, volume);
  for (std::size_t pair = 0; pair < out.size(); ++pair) out[pair] *= contact[pair];
  return out;
}

std::vector<double> counted_rates_by_pair(const LoadedScene& loaded) {
  const Composition composition = loaded.scene.composition();
  const auto start = temperatures_by_species(loaded);
  if (composition.has_width())
    return between_walls(loaded, rates_by_means(loaded, composition, start), start);
  Composition paired = composition;  // with a rate of each species with itself
  for (std::size_t n = 0; n < composition.size(); ++n) {
    if (composition[n].count == 1) paired.set_count(n, 2);
  }
  std::vector<double> rates = between_walls(loaded, rates_by_means(loaded, paired, start), start);
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
  return per_moving_needle(composition, counted_rates_by_pair(loaded));
}

double per_moving_needle(const Composition& composition, const std::vector<double>& by_pair) {
  double all = 0;
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const int moving = !composition[a].fixed + !composition[b].fixed;
      all += moving * by_pair[composition.pair_index(a, b)];
    }
  }
  return all / static_cast<double>(composition.count() - composition.fixed());
}

bool starts_in_equilibrium(const Scene& scene) {
  const Composition composition = scene.composition();
  if (composition.fixed() == composition.count()) return false;
  const double t = temperature_of(composition);
  return !composition.is_inelastic() && stays_at_temperature(scene, t) &&
         scene.initial.file.empty() && t > 0 &&
         std::ranges::all_of(composition.species(),
                             [&](const Species& s) {
                               return s.fixed || (s.t_tr == t && (s.t_rot == t || !s.turns()));
                             }) &&
         composition.count() >= 2;
}

std::vector<double> equilibrium_rates_by_pair(const Scene& scene, double energy) {
  const Composition composition = scene.composition();
  if (!starts_in_equilibrium(scene) || composition.has_width()) return {};
  // Bodies that differ are not followed between walls.
  if (composition.has_own_sizes() && !(scene.walls.empty() && has_known_bodies(scene))) return {};
  std::vector<double> rates = open_equilibrium_rates(scene, energy);
  // For the factor only the ratios of temperatures count.
  const auto now = at_temperature(composition, temperature_of(composition));
  if (rates.empty() || !put_between_walls(scene, now, rates)) return {};
  return rates;
}

double equilibrium_rate(const Scene& scene, double energy) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const double count = static_cast<double>(scene.needles.count);
  const Composition composition = scene.composition();
  if (!composition.is_needle_gas()) {
    const std::vector<double> rates = equilibrium_rates_by_pair(scene, energy);
    if (rates.empty()) return unknown;
    return 2 * std::accumulate(rates.begin(), rates.end(), 0.0) / count;
  }
  if (!starts_in_equilibrium(scene)) return unknown;
  const Species& species = composition[0];
  const auto factor = factor_between_walls(scene, species, {1, 1}, species, {1, 1});
  if (!factor) return unknown;
  const double t = temperature_of(composition);
  const double cube = species.length * species.length * species.length;
  const double volume = volume_of(scene) / cube;
  const double rate = exchanges_energy(scene)
                          ? theory::collision_rate((count - 1) / volume, {t, t}, species.k)
                          : theory::equilibrium_rate(count, volume, count * energy, species.k,
                                                     conserved_momenta(scene));
  return *factor * rate / (species.length * std::sqrt(species.mass));
}

}  // namespace needlework::runs
