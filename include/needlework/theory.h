// Kinetic theory of the homogeneous needle gas: exact rates for Gaussian velocities, and the
// cooling curve under the assumption that the gas stays Gaussian and homogeneous. Units: L = m =
// 1. Relative accuracy: about 1e-14 for integrals and rates, 1e-11 for cooling curves with k in
// [0.01, 1e4] (far outside, the smaller temperature loses digits).
//
// Source: M. Huthmann, T. Aspelmeier, A. Zippelius, "Granular cooling of hard needles", for smooth
// needles (beta = -1). The rates of rough needles follow in the same way from the impulse with
// tangential restitution. All functions are pure, so threads may call them freely. All throw
// std::invalid_argument, "NAME = VALUE: expected ...", for a number out of range or NaN.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "needlework/composition.h"

namespace needlework::theory {

/// The parameters of the theory.
struct Gas {
  double k = 6.0;        ///< m L^2 / (2 I), [1e-12, 1e12]
  double epsilon = 1.0;  ///< normal restitution, [0, 1]
  double beta = -1.0;    ///< tangential restitution, [-1, 1]; -1 is smooth
};

/// Translational and rotational temperatures, or their derivatives in tau.
struct Temperatures {
  double t_tr = 1.0;   ///< 2/3 of the translational energy of a needle
  double t_rot = 1.0;  ///< the rotational energy of a needle, 2/3 of that of a rough sphere
  double turning = 1;  ///< Composition::turning_share()
  double energy() const { return 1.5 * t_tr + turning * t_rot; }  ///< per needle
};

/// Integral over the unit square, centred at the origin, of sqrt(1 + q k r^2), with
/// q = T_rot / T_tr >= 0 and any k > 0. [1]
double collision_integral(double q, double k);

/// Collisions that one needle takes part in per unit time at number density `density` [L^-3]:
/// n (sqrt(pi)/2) sqrt(T_tr) times the collision integral. Exact for Gaussian velocities, at every
/// density. T_tr = 0 with T_rot > 0 is the limit q -> infinity; both 0 give 0.
double collision_rate(double density, Temperatures temperatures, double k);

/// The elastic equilibrium collision rate of one needle, for N needles with zero momentum and
/// fixed energy in a volume V: density (N - 1) / V, temperature 2 E_total / (5 N - 3), times the
/// microcanonical factor sqrt(D/2) Gamma(D/2) / Gamma((D+1)/2), D = 5 N - 3. `count` >= 2.
/// `conserved` is the number of components of the momentum that are conserved, 0 to 3, which is in
/// the place of that 3: walls leave those along the periodic axes alone.
double equilibrium_rate(double count, double volume, double total_energy, double k,
                        int conserved = 3);

/// What a fixed energy of all freedoms makes of velocities.
struct Equilibrium {
  double temperature;  ///< 2 E / D [energy]
  double
      speed;  ///< of a mean relative velocity, over that of Gaussian ones of this temperature [1]
};

/// Of `count` >= 1 needles that share this energy, D = 5 `count` - `conserved`.
Equilibrium equilibrium_of(double count, double total_energy, int conserved = 3);

/// d(T_tr, T_rot) / d tau at this instant, with tau = gamma t and gamma = (2/3) sqrt(pi) n. Exact
/// for Gaussian velocities. Either temperature may be 0. In an elastic gas the energy 3/2 T_tr +
/// T_rot is conserved to rounding.
Temperatures cooling_rates(const Gas& gas, Temperatures now);

/// The cooling curve: the temperatures at each of the times `taus` (finite, >= 0, any order),
/// tau = gamma t with gamma = (2/3) sqrt(pi) n, from the temperatures `initial` at tau = 0.
std::vector<Temperatures> cooling_curve(const Gas& gas, Temperatures initial,
                                        std::span<const double> taus);

/// The same curve, followed step by step: cheap where times become known one after the other.
class CoolingCurve {
 public:
  CoolingCurve(const Gas& gas, Temperatures initial);
  CoolingCurve(CoolingCurve&&) noexcept;
  CoolingCurve& operator=(CoolingCurve&&) noexcept;
  ~CoolingCurve();

  /// The temperatures at a time (finite, >= 0) that must not be before that of the last call.
  Temperatures at(double tau);

  /// Where the curve has come to: what another curve of the same gas needs to give the same next
  /// values, to the last bit.
  using Place = std::array<double, 5>;
  Place place() const;
  /// Throws InputError for a place that no curve can have come to.
  void go_to(const Place& place);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Collisions per needle between tau = 0 and each of the times `taus`, along the same cooling
/// curve.
std::vector<double> collisions_per_needle(const Gas& gas, Temperatures initial,
                                          std::span<const double> taus);

/// The long-time ratio c = T_tr / T_rot of a cooling gas. NaN if the gas does not cool, because it
/// is elastic (epsilon = 1 and beta = -1 or 1).
double asymptotic_ratio(const Gas& gas);

/// The same of alike rough spheres of this 4 I / (m D^2), if velocities stay Gaussian and
/// independent of spins. They do not: T_rot / T_tr is up to 10 % less between beta = -0.75 and
/// 0.25. NaN of smooth spheres, whose rotation nothing changes. Source: M. Huthmann, A. Zippelius,
/// Phys. Rev. E 56, R6275 (1997).
double asymptotic_ratio_of_spheres(double q, const Restitution& rule);

/// The k at which c = 1 for every epsilon < 1 (beta = -1).
double equipartition_k();

/// What the needles of one species do to hard walls: per needle and time, for each wall of an axis.
/// [1 / time], [energy / L]
struct WallRates {
  double hits = 0;   ///< of either wall
  double force = 0;  ///< of elastic hits; (1 + epsilon) / 2 of that where they are not
};

/// For a box whose axes have walls at both edges, or none. Exact, at every density, where no
/// gravity acts, for Gaussian velocities and positions and directors of which nothing is known but
/// that both tips are inside: in elastic equilibrium and in a state that is drawn. Edges with walls
/// must be at least the length. Of walls that move towards the gas at the speed `advance`, or away
/// from it, as long as they have changed nothing but what they hit: at the start of a drawn state.
/// [L / time]
std::array<WallRates, 3> wall_rates(const Species& species, const std::array<double, 3>& box,
                                    const std::array<bool, 3>& walled, Temperatures now,
                                    double advance = 0);

/// Collisions of needles of species a with those of species b between two walls along one axis
/// alone, in multiples of those in a periodic box of the same volume: exact for the states of
/// wall_rates(). There is less room for the centres, but near the walls only for directors along
/// them. `gap` is the distance of the walls, at least both lengths. Accurate to 1e-6. [1]
double pair_factor_between_walls(const Species& a, Temperatures at_a, const Species& b,
                                 Temperatures at_b, double gap);

/// Energy that kicks give, per needle and time, for elastic and inelastic needles alike: every dt
/// each component of a velocity changes by a Gaussian number of variance translational^2 dt, each
/// of the two or three of an angular velocity by one of rotational^2 dt, and the momentum that this
/// gives is taken off, unless there are fixed ones. Needles are those that move. [energy / time]
double kick_power(const Composition& composition, double translational, double rotational);

/// The steady state of a gas in uniform shear at low density.
struct SteadyShear {
  double t_tr, t_rot;  ///< [energy]
  double collisions;   ///< per body, in which the gas forgets how it was
};
/// Of alike smooth spheres by linear moments (Grad), which is 3 % too high at epsilon = 0.9 and 12
/// % at 0.7; of alike smooth needles with k = 6 by simulated encounters at 0.9 and 0.7 and what
/// lies between and about. Of n bodies per volume [L^-3] and this rate [1 / time]; nothing for
/// others, or where there is no steady state.
std::optional<SteadyShear> steady_shear(const Species& body, double epsilon, double density,
                                        double rate);

/// What happens in a mixture at one instant, in the units of the composition, in which k_B = 1.
struct MixtureRates {
  std::vector<double> collisions;          ///< of each two species, by Composition::pair_index
                                           ///< [1 / time]
  std::vector<Temperatures> temperatures;  ///< derivatives of the temperatures of each species
};

/// Of mixtures with more species the rates of all pairs are too many to be worth their time:
/// callers should leave theory out.
inline constexpr std::size_t most_species_of_theory = 8;

/// Rates of a mixture in this volume [L^3] whose species have Gaussian velocities with temperatures
/// of their own, and positions and directors without correlation: exact then at every density, for
/// any lengths, masses, k, q and restitution of each two species, in the limit of many needles (a
/// species of N needles counts as N (N - 1) / 2 pairs of its own).
MixtureRates mixture_rates(const Composition& composition, double volume,
                           std::span<const Temperatures> now);

/// By how much bodies of each two species, by Composition::pair_index, are more often in contact in
/// an elastic fluid in equilibrium without order than at low density: 1 for needles. Of spheres the
/// values of G. A. Mansoori, N. F. Carnahan, K. E. Starling and T. W. Leland, J. Chem. Phys. 54,
/// 1523 (1971). Rods count as the spheres with which these give the pressure that I. Nezbeda, Chem.
/// Phys. Lett. 41, 55 (1976), finds of rods alone at the same packing fraction. Where spheres of a
/// species differ, the mean over its bodies, by (D + D')^2. Overlapping fixed ones do not crowd.
std::vector<double> contact_values(const Composition& composition, double volume);

/// p V / (N T) of spheres in such a fluid, by the same authors, from the means of D, D^2 and D^3 of
/// the bodies that there are: right to 1 % up to a packing fraction of some 0.5. [1]
double sphere_compressibility(const Composition& composition, double volume);

/// Second virial coefficient of rods whose directors are uniformly distributed, 0 for needles: at
/// low density n the pressure of elastic rods in equilibrium is n T (1 + n B). [L^3]
double second_virial(const Composition& composition);

/// Collisions of each two species per unit time in elastic equilibrium, by Composition::pair_index,
/// of needles with zero momentum and this energy of all in a volume: the rates at the temperature
/// T = 2 E / (5 N - 3) of all of them, times the factor of equilibrium_rate(). At least two
/// needles; N are those that move. `conserved` as there.
std::vector<double> mixture_equilibrium_rates(const Composition& composition, double volume,
                                              double total_energy, int conserved = 3);

/// The temperatures of all needles that move together, so that they give the mean energy: T_rot is
/// the mean over all rotational degrees of freedom.
Temperatures mean_of_species(const Composition& composition, std::span<const Temperatures> each);

/// The temperatures of each species at each of the times (finite, >= 0, any order), from those
/// given at time 0, of a mixture that stays Gaussian and homogeneous. Relative accuracy about 1e-8.
/// NaN where ratios of temperatures have not relaxed after 1000 collisions per needle.
std::vector<std::vector<Temperatures>> mixture_cooling(const Composition& composition,
                                                       double volume,
                                                       std::span<const Temperatures> initial,
                                                       std::span<const double> times);

/// The same course, followed step by step: cheap where times become known one after the other.
class MixtureCurve {
 public:
  /// `contact`: how many times more often bodies of each two species collide, by
  /// Composition::pair_index; 1 where nothing is given.
  MixtureCurve(const Composition& composition, double volume, std::span<const Temperatures> initial,
               std::vector<double> contact = {});
  MixtureCurve(MixtureCurve&&) noexcept;
  MixtureCurve& operator=(MixtureCurve&&) noexcept;
  ~MixtureCurve();

  /// The temperatures at a time (finite, >= 0) that must not be before that of the last call.
  std::vector<Temperatures> at(double time);

  /// Where the curve has come to: what another curve of the same mixture needs to give the same
  /// next values, to the last bit.
  std::vector<double> place() const;
  /// Throws InputError for a place that no curve can have come to.
  void go_to(std::span<const double> place);

  /// Collisions per needle between time 0 and the time of the last call.
  double collisions_per_needle() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace needlework::theory
