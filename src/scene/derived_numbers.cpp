#include "src/scene/derived_numbers.h"

#include <fmt/format.h>

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
  const Scene::Species species = scene.one_species();
  const auto count = static_cast<double>(species.count);
  const double per_mass = count / species.mass;
  return {.count = count,
          .length = species.length,
          .mass = species.mass,
          .k = species.k,
          .v2 = 3 * species.t_tr * per_mass,
          .w2 = 4 * species.k * species.t_rot / (species.length * species.length) * per_mass,
          .moves = count > 0 && (species.t_tr > 0 || species.t_rot > 0)};
}

std::string out_of_range(const GasNumbers& gas) {
  if (!gas.moves) return {};
  const double squared_length = gas.length * gas.length;
  const double inertia_per_mass = squared_length / (2 * gas.k);
  // Twice the energy per mass.
  const double squares = gas.v2 + inertia_per_mass * gas.w2;
  const double energy = 0.5 * gas.mass * squares;
  // Collisions may give all of the energy to the flight or to the rotation of one needle.
  const double speed = squares, rate = squares / squared_length,
               rotation = squares / inertia_per_mass;
  const double mean_rate = (gas.v2 / squared_length + gas.w2) / gas.count;
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
