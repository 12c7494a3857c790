#include "src/scene/derived_numbers.h"

#include <fmt/format.h>

#include <algorithm>

namespace needlework {
namespace {

// Squares, and products of them with squares of lengths in the box, are then finite.
constexpr double largest_square = 1e290;
// Squares and energies then keep all digits, and energies are counted in quanta of 2^-58 of them.
constexpr double least_square = 1e-243;
// By the end of its clock, after 2^62 epochs, a gas has not lost more of its energy than this.
constexpr double cooled = 1e-40;

}  // namespace

GasNumbers numbers_of_drawn(const Scene& scene) {
  const Composition composition = scene.composition();
  GasNumbers out{.count = static_cast<double>(composition.count() - composition.fixed()),
                 .species = {},
                 .moves = false};
  for (const Species& species : composition.species()) {
    if (species.fixed) continue;
    const auto count = static_cast<double>(species.count);
    const double per_mass = count / species.mass;
    out.species.push_back({.mass = species.mass,
                           .inertia = species.inertia(),
                           .v2 = 3 * species.t_tr * per_mass,
                           .w2 = species.w2_at(species.t_rot) * count,
                           .extent = species.extent()});
    out.moves = out.moves || (count > 0 && (species.t_tr > 0 || species.t_rot > 0));
  }
  return out;
}

std::string out_of_range(const GasNumbers& gas) {
  if (!gas.moves) return {};
  double energy = 0, mean_rate = 0;
  for (const SpeciesNumbers& each : gas.species) {
    energy += 0.5 * each.mass * (each.v2 + each.inertia / each.mass * each.w2);
    mean_rate += (each.v2 / (each.extent * each.extent) + each.w2) / gas.count;
  }
  // Collisions may give all of the energy to the flight or to the rotation of one needle.
  double speed = 0, rate = 0, rotation = 0;
  for (const SpeciesNumbers& each : gas.species) {
    const double squares = energy / (0.5 * each.mass);
    speed = std::max(speed, squares);
    rate = std::max(rate, squares / (each.extent * each.extent));
    if (each.inertia == 0) continue;
    rotation = std::max(rotation, squares / (each.inertia / each.mass));
  }
  const double least = least_square * (gas.has_cooled ? cooled : 1);
  struct Number {
    const char* what;
    double value, least, most;
  };
  for (const auto& [what, value, from, to] :
       {Number{"an energy", energy, least, largest_square},
        Number{"a square of the largest possible speed", speed, 0, largest_square},
        Number{"a square of the largest possible speed in needle lengths", rate, 0, largest_square},
        Number{"a square of the largest possible angular velocity", rotation, 0, largest_square},
        Number{"a mean square of speeds in needle lengths and of angular velocities", mean_rate,
               least, largest_square}}) {
    if (value >= from && value <= to) continue;
    const bool small = value < from;
    return fmt::format("{} of {:.3g}: expected at {} {:.3g}, in the units of the engine", what,
                       value, small ? "least" : "most", small ? from : to);
  }
  return {};
}

}  // namespace needlework
