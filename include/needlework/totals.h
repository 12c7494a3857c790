// Sums over all needles at one instant.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "needlework/described.h"

namespace needlework {

/// Sums over all needles at one instant, which do not depend on the order of the needles.
struct Totals {
  double time = 0;
  double t_tr = 0;    ///< (2/3) <m v^2 / 2>
  double t_rot = 0;   ///< <I w^2 / 2> of those that turn, <I w^2> / 3 of rough spheres
  double energy = 0;  ///< with gravity g along axes with walls that of -m g r, r counted from the
                      ///< low edges of the box
  std::array<double, 3> momentum{};
  std::uint64_t collisions = 0;
  std::uint64_t tc_collisions = 0;

  /// Calls visit(Described, member) for each number but the time, which in files is that of a row.
  template <class Visit>
  static constexpr void for_each_sum(Visit&& visit) {
    visit(Described{"t_tr", unit::energy,
                    "Translational temperature: two thirds of the mean energy of translation"},
          &Totals::t_tr);
    visit(
        Described{"t_rot", unit::energy,
                  "Rotational temperature: the mean energy of rotation per two degrees of freedom"},
        &Totals::t_rot);
    visit(Described{"energy", unit::energy,
                    "Kinetic energy per needle, and that in gravity between walls"},
          &Totals::energy);
    visit(Described{"momentum", unit::momentum, "Total momentum of all needles"},
          &Totals::momentum);
    visit(Described{"collisions", unit::none, "Number of collisions since the start of the run"},
          &Totals::collisions);
    visit(Described{"tc_collisions", unit::none,
                    "Number of collisions since the start of the run that the contact-time rule "
                    "made elastic"},
          &Totals::tc_collisions);
  }

  /// The same for all numbers.
  template <class Visit>
  static constexpr void for_each_member(Visit&& visit) {
    visit(Described{"time", unit::time, "Time since the start of the run"}, &Totals::time);
    for_each_sum(visit);
  }

  /// Calls visit(Described, value) for each number, here and below in the order of all interfaces.
  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    for_each_member([&](const Described& number, auto member) { visit(number, this->*member); });
  }
};

/// What Totals has of the needles of one species.
struct SpeciesTotals {
  std::uint64_t count = 0;
  double t_tr = 0, t_rot = 0;

  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    visit(Described{"count", unit::none, "Number of needles"}, count);
    visit(Described{"t_tr", unit::energy,
                    "Translational temperature, two thirds of the mean energy of translation"},
          t_tr);
    visit(
        Described{"t_rot", unit::energy,
                  "Rotational temperature, the mean energy of rotation per two degrees of freedom"},
        t_rot);
  }
};

/// What has happened at one object of a source of events, such as a wall, since the start of a run.
struct ObjectTotals {
  std::uint64_t events = 0;
  double impulse = 0;                ///< sum of |J| [m L / time]
  double normal_impulse = 0;         ///< sum of their components along the normal of the object
  std::array<double, 3> momentum{};  ///< sum of J [m L / time]
  double work = 0;                   ///< done by its motion [energy]
};

/// Hits of needles on one wall since the start of a run.
struct WallTotals {
  int axis = 0;       ///< 0, 1, 2 for x, y, z
  bool high = false;  ///< at the high edge of the box, else at the low one
  std::uint64_t hits = 0;
  double impulse = 0, normal_impulse = 0, area = 0, phase = 0, energy = 0;
  double pressure = std::numeric_limits<double>::quiet_NaN();
  double place = 0, work = 0, impulse_x = 0, impulse_y = 0, impulse_z = 0;

  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    visit(Described{"hits", unit::none, "Number of hits, which are no collisions"}, hits);
    visit(Described{"impulse", unit::momentum, "Sum of the magnitudes of their impulses"}, impulse);
    visit(Described{"normal_impulse", unit::momentum,
                    "Sum of the components of these impulses along the normal into the gas, which "
                    "thermal walls may draw negative"},
          normal_impulse);
    visit(Described{"area", unit::area, "Area of the face of the box at the wall"}, area);
    visit(
        Described{"phase", unit::angle,
                  "Phase of the motion of the wall now, from 0 to 2 pi, so that its surface is off "
                  "by amplitude times its sine; NaN at rest"},
        phase);
    visit(Described{"energy", unit::energy,
                    "Energy that hits have put into the gas, per needle; negative: taken out"},
          energy);
    visit(Described{"pressure", unit::pressure,
                    "Mean over the run, impulse along the normal over area and time; NaN at its "
                    "start"},
          pressure);
    visit(Described{"place", unit::length, "Place of its surface along its axis now"}, place);
    visit(Described{"work", unit::energy,
                    "Of its energy, what its motion has done as work, per needle; the rest is "
                    "heat, or what its restitution takes"},
          work);
    visit(Described{"impulse_x", unit::momentum, "Sum of the impulses on the gas, along x"},
          impulse_x);
    visit(Described{"impulse_y", unit::momentum, "The same along y"}, impulse_y);
    visit(Described{"impulse_z", unit::momentum, "The same along z"}, impulse_z);
  }
};

/// Bodies that grow.
struct GrowthTotals {
  double scale = 1, rate = 0, packing_fraction = 0;
  double pressure = std::numeric_limits<double>::quiet_NaN();

  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    visit(Described{"scale", unit::none, "Present sizes of bodies in those of the start"}, scale);
    visit(Described{"rate", unit::rate, "What this scale gains in a unit of time"}, rate);
    visit(Described{"packing_fraction", unit::none,
                    "Share of the volume of the box that bodies take up now"},
          packing_fraction);
    visit(Described{"pressure", unit::none,
                    "P V / (N T) by the virial, as it was last measured, over the collisions "
                    "between two times at which velocities were scaled back; NaN before"},
          pressure);
  }
};

/// Contacts of needles that slide on each other, since the start of the run. Each that was entered
/// has ended, or lasts.
struct SlidingContacts {
  std::uint64_t entered = 0, ended_by_force = 0, ended_by_tip = 0, ended_by_strike = 0, crowded = 0;
  double time = 0, share = 0;

  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    visit(Described{"entered", unit::none, "Number of contacts that have begun"}, entered);
    visit(
        Described{"ended_by_force", unit::none,
                  "Number of them that have ended where the force that holds the needles together "
                  "would pull"},
        ended_by_force);
    visit(Described{"ended_by_tip", unit::none,
                    "Number of them that have ended as a tip was reached; the needles pass each "
                    "other"},
          ended_by_tip);
    visit(Described{"ended_by_strike", unit::none,
                    "Number of them that have ended as anything else changed the velocities of one "
                    "of the needles"},
          ended_by_strike);
    visit(Described{"crowded", unit::none,
                    "Number of collisions whose epsilon was raised, as one of the needles had just "
                    "touched another one or a wall"},
          crowded);
    visit(
        Described{"time", unit::time,
                  "Time that pairs have been in contact, of all together, without that of present "
                  "steps"},
        time);
    visit(Described{"share", unit::none,
                    "Share of its time that a needle has been in contact, the mean of all: "
                    "2 time / (N t); NaN at the start"},
          share);
  }
};

/// Nine numbers by [transport][momentum]: the axis along which momentum goes, and its component.
using Tensor = std::array<std::array<double, 3>, 3>;

/// The pressure tensor times volume and time, summed since the start of a run; velocities count
/// from the flow of [shear]. [energy time]
struct StressSums {
  Tensor kinetic{};      ///< sum of m c c t over flights
  Tensor collisional{};  ///< sum of r12 dp over collisions, r12 between the centres
};

/// The pressure tensor, as a mean over a time, and what follows from it.
struct StressTotals {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  Tensor kinetic{{{none, none, none}, {none, none, none}, {none, none, none}}};
  Tensor collisional = kinetic;
  /// Each with a standard error by the method of batch means.
  double shear_stress = none, shear_stress_error = none;
  double viscosity = none, viscosity_error = none;
  double first_normal_difference = none, first_normal_difference_error = none;
  double second_normal_difference = none, second_normal_difference_error = none;

  /// The mean of what has come to sums in this time.
  static StressTotals between(const StressSums& from, const StressSums& to, double time,
                              double volume, const std::array<bool, 3>& periodic, double rate) {
    StressTotals out;
    if (!(time > 0)) return out;
    const double share = 1 / (volume * time);
    for (std::size_t a = 0; a < 3; ++a) {
      // Between walls, their force is the pressure.
      if (!periodic[a]) continue;
      for (std::size_t b = 0; b < 3; ++b) {
        out.kinetic[a][b] = (to.kinetic[a][b] - from.kinetic[a][b]) * share;
        out.collisional[a][b] = (to.collisional[a][b] - from.collisional[a][b]) * share;
      }
    }
    const auto all = [&](std::size_t a, std::size_t b) {
      return out.kinetic[a][b] + out.collisional[a][b];
    };
    out.shear_stress = -all(1, 0);
    out.viscosity = rate != 0 ? out.shear_stress / rate : none;
    out.first_normal_difference = all(0, 0) - all(1, 1);
    out.second_normal_difference = all(1, 1) - all(2, 2);
    return out;
  }

  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    constexpr Described of_flights[3][3] = {
        {{"kinetic_xx", unit::pressure, "P_xx by flights: n <m c_x c_x>"},
         {"kinetic_xy", unit::pressure, "P_xy by flights"},
         {"kinetic_xz", unit::pressure, "P_xz by flights"}},
        {{"kinetic_yx", unit::pressure, "P_yx by flights, momentum along x that goes along y"},
         {"kinetic_yy", unit::pressure, "P_yy by flights"},
         {"kinetic_yz", unit::pressure, "P_yz by flights"}},
        {{"kinetic_zx", unit::pressure, "P_zx by flights"},
         {"kinetic_zy", unit::pressure, "P_zy by flights"},
         {"kinetic_zz", unit::pressure, "P_zz by flights"}}};
    constexpr Described of_collisions[3][3] = {
        {{"collisional_xx", unit::pressure, "P_xx by collisions: r12_x dp_x between centres"},
         {"collisional_xy", unit::pressure, "P_xy by collisions"},
         {"collisional_xz", unit::pressure, "P_xz by collisions"}},
        {{"collisional_yx", unit::pressure, "P_yx by collisions, r12_y dp_x"},
         {"collisional_yy", unit::pressure, "P_yy by collisions"},
         {"collisional_yz", unit::pressure, "P_yz by collisions"}},
        {{"collisional_zx", unit::pressure, "P_zx by collisions"},
         {"collisional_zy", unit::pressure, "P_zy by collisions"},
         {"collisional_zz", unit::pressure, "P_zz by collisions"}}};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) visit(of_flights[a][b], kinetic[a][b]);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) visit(of_collisions[a][b], collisional[a][b]);
    visit(Described{"shear_stress", unit::pressure, "-P_yx"}, shear_stress);
    visit(Described{"shear_stress_error", unit::pressure, "Its standard error"},
          shear_stress_error);
    visit(Described{"viscosity", unit::viscosity, "-P_yx over the rate; NaN without shear"},
          viscosity);
    visit(Described{"viscosity_error", unit::viscosity, "Its standard error"}, viscosity_error);
    visit(Described{"first_normal_difference", unit::pressure, "P_xx - P_yy"},
          first_normal_difference);
    visit(Described{"first_normal_difference_error", unit::pressure, "Its standard error"},
          first_normal_difference_error);
    visit(Described{"second_normal_difference", unit::pressure, "P_yy - P_zz"},
          second_normal_difference);
    visit(Described{"second_normal_difference_error", unit::pressure, "Its standard error"},
          second_normal_difference_error);
  }
};

/// What each effect has put into the energy of the needles since the start of a run, as energy per
/// needle; negative where it has taken energy out. The sum is the change of Totals::energy, up to
/// the rounding of needles' motion (Simulation::energy_drift). Effects that the scene has not have
/// no value.
struct EnergyBudget {
  double pairs = 0;
  std::vector<double> walls;  ///< in the order of wall_totals()
  std::optional<double> thermostat, kicks, gravity, shear, growth, cooling;
  double velocities_set = 0;

  /// With 0 for what the scene has not.
  EnergyBudget complete() const {
    EnergyBudget out = *this;
    if (walls.empty()) out.walls = {0};
    for (std::optional<double>* each :
         {&out.thermostat, &out.kicks, &out.gravity, &out.shear, &out.growth, &out.cooling})
      if (!*each) *each = 0;
    return out;
  }

  /// Calls visit(Described, value) for each that there is; the value of walls is an array.
  template <class Visit>
  void for_each(Visit&& visit) const {
    visit(Described{"pairs", unit::energy, "Energy by collisions of two needles"}, pairs);
    if (!walls.empty()) {
      visit(Described{"walls", unit::energy, "Energy by hits on each wall"}, walls);
    }
    if (thermostat) {
      visit(Described{"thermostat", unit::energy, "Energy by the thermostat"}, *thermostat);
    }
    if (kicks) visit(Described{"kicks", unit::energy, "Energy by kicks"}, *kicks);
    visit(Described{"velocities_set", unit::energy,
                    "Energy by velocities that a caller has replaced"},
          velocities_set);
    if (gravity) {
      visit(Described{"gravity", unit::energy, "Energy by gravity along periodic axes"}, *gravity);
    }
    if (shear) visit(Described{"shear", unit::energy, "Energy by uniform shear"}, *shear);
    if (growth) {
      visit(Described{"growth", unit::energy, "Energy by growth, which pushes bodies apart"},
            *growth);
    }
    if (cooling) {
      visit(Described{"cooling", unit::energy,
                      "Energy by velocities that are scaled back as bodies grow"},
            *cooling);
    }
  }
};

/// "x", "y" or "z", and "low" or "high", as in scenes.
inline const char* axis_name(const WallTotals& wall) {
  constexpr const char* names[] = {"x", "y", "z"};
  return names[wall.axis];
}
inline const char* side_name(const WallTotals& wall) { return wall.high ? "high" : "low"; }

}  // namespace needlework
