// A forecast of a run by kinetic theory.
#pragma once

#include <optional>
#include <vector>

#include "needlework/scene.h"
#include "needlework/stop.h"
#include "needlework/theory.h"
#include "needlework/totals.h"

namespace needlework {

/// Where a gas that stays homogeneous and Gaussian meets the first of its end conditions.
struct Forecast {
  Stop stop = Stop::time;            ///< the condition that is met
  double time = 0;                   ///< since the start of the run; may be infinite
  double collisions_per_needle = 0;  ///< without collisions by the t_c rule
  double energy_ratio = 1;           ///< E / E(0)
};

/// Of a gas that keeps its energy and has so many collisions per needle and time; empty if no
/// condition but wall_s is ever met.
std::optional<Forecast> forecast_at_rate(double rate, const Scene::Until& until);

/// Ratio tau / t = (2/3) sqrt(pi) n between the theory's time and the engine's.
double theory_time_scale(double density);

/// The same of a mixture of at most theory::most_species_of_theory species in a volume, or of rods,
/// which collide as often as theory::contact_values() says.
std::optional<Forecast> forecast(const Composition& composition, double volume,
                                 const std::vector<theory::Temperatures>& initial,
                                 const Scene::Until& until);

/// The forecast from these temperatures; empty if no condition but wall_s is ever met.
std::optional<Forecast> forecast(const theory::Gas& gas, theory::Temperatures initial,
                                 double density, const Scene::Until& until);

}  // namespace needlework
