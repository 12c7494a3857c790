// Sums over all needles of a gas, and what follows from them.
#pragma once

#include <vector>

#include "needlework/totals.h"
#include "src/engine/stress.h"
#include "src/physics/gas.h"
#include "src/scene/derived_numbers.h"

namespace needlework {

/// How much a needle counts in the sums of its species: its mass and moment of inertia over those
/// of the species. Both are exactly 1 where its body is that of the species, so that weighted sums
/// have the bits of plain ones; of smooth spheres, which do not turn, the second is 1.
struct Weight {
  double mass = 1, inertia = 1;
};
Weight weight_of(const Gas& gas, Needle i);

/// Sums over all needles of a species, on which its energy depends: w2 is weighted by moments of
/// inertia, the others by masses.
struct SumsOfSquares {
  double v2 = 0, w2 = 0;  ///< [L^2 / time^2], [1 / time^2]
  double height = 0;      ///< above where gravity points to, times gravity [L^2 / time^2]
  double pulled = 0;      ///< way along periodic axes, images included, times gravity there
};

/// Of all needles of each species. The threads share the work; see exact_sums.h.
std::vector<SumsOfSquares> sums_of_squares(const Gas& gas, Time now, int threads);

/// What a needle carries in its flight from its record to `now`: the integral of c c, c its
/// velocity beside the flow.
struct FlightCarries {
  double mass;
  Tensor cc;
};
FlightCarries flight_carries(const Gas& gas, Needle i, Time now);
/// The sum of m c c t over the flights of all needles from their records to `now`. [energy time]
Tensor carried_in_flights(const Gas& gas, Time now, int threads);
/// What uniform shear does to the energy in these flights. [energy]
double work_of_flow_in_flights(const Gas& gas, Time now, int threads);

std::vector<SpeciesTotals> species_totals(const Gas& gas, const std::vector<SumsOfSquares>& sums);
/// The energy of all needles; where there is gravity along axes with walls, counted from those to
/// which it points, so that it is positive. [energy]
double energy_of(const Gas& gas, const std::vector<SumsOfSquares>& sums);
/// Without that in gravity. [energy]
double energy_of_motion(const Gas& gas, const std::vector<SumsOfSquares>& sums);
/// The work that gravity along periodic axes has done since needles were in the box. [energy]
double work_of_pull(const Gas& gas, const std::vector<SumsOfSquares>& sums);
/// What energy_of() is more than where heights count from the low edges of the box. [energy]
double energy_of_low_edges(const Gas& gas);
/// Temperatures, energy and momentum; times and counts are left as they are.
Totals totals_of(const Gas& gas, Time now, int threads);
/// Of all needles. [energy]
double translational_temperature(const Gas& gas, const std::vector<SumsOfSquares>& sums);
/// By kinetic theory, for what these sums say of temperatures. [time]
double mean_free_time_of(const Gas& gas, const std::vector<SumsOfSquares>& sums, Time now);
/// What tells whether searches can follow needles with these sums of squares; `moves` is whether
/// any needle does.
GasNumbers numbers_of(const Gas& gas, const std::vector<SumsOfSquares>& sums, bool moves);

}  // namespace needlework
