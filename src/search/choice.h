// What `auto` stands for, by the number of needles per L^3 around a needle, L the length of the
// needles; see sizing.h. `needlework bench hulls` compares these sizes with others, for
// masses from the tips to the centre of the needles.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "needlework/composition.h"

namespace needlework {

/// The mean length of the needles, as a share of the longest one.
inline double mean_length(const Composition& composition) {
  const double longest = composition.longest();
  double sum = 0, count = 0;
  for (const Species& each : composition.species()) {
    sum += static_cast<double>(each.count) * (each.extent() / longest);
    count += static_cast<double>(each.count);
  }
  return count > 0 ? sum / count : 1;
}

/// Needles per cube of their mean length, where there are so many per cube of the longest one: the
/// density of the gas of one length that collides as often, since two needles meet about as often
/// as the product of their lengths says.
inline double density_by_mean(double density, const Composition& composition) {
  const double share = mean_length(composition);
  return density * (share * share * share);
}

/// Means over bodies, by which they exclude each other.
struct MeanSizes {
  double length = 0, diameter = 0;  ///< [L]
  double product = 0, square = 0;   ///< of both, and of the diameter [L^2]

  static MeanSizes of(const Species& all) {
    return {all.length, all.diameter, all.product(), all.square()};
  }
};

/// The area of the body that two rods exclude, averaged over their directions, over that of needles
/// of length 1: L^2 for needles, and more by the caps and the width.
/// (2 L^2 sin + 4 pi D L + 4 pi D^2 for two alike.) [L^2]
inline double excluded_area(const MeanSizes& a, const MeanSizes& b) {
  const double sides = a.product + b.product + a.length * b.diameter + a.diameter * b.length;
  return a.length * b.length + 2 * sides + 2 * (a.square + 2 * a.diameter * b.diameter + b.square);
}

/// By how much neighbours are more frequent in contact than at low density, as Carnahan's and
/// Starling's equation says of spheres, which is about right for rods. Density: rods per cube of
/// the longest one.
inline double crowding_by_packing(double density, const Composition& composition) {
  const double longest = composition.longest();
  double volume = 0, count = 0;
  for (const Species& each : composition.species()) {
    volume += static_cast<double>(each.count) * each.volume();
    count += static_cast<double>(each.count);
  }
  if (!(volume > 0)) return 1;
  const double packing = std::min(0.6, density * volume / (count * longest * longest * longest)),
               room = 1 - packing;
  return (1 - 0.5 * packing) / (room * room * room);
}

/// How much more often rods collide than needles as long from end to end of the same density. 1 for
/// needles. Density: rods per cube of the longest one.
inline double crowding_by_width(double density, const Composition& composition) {
  if (!composition.has_width()) return 1;
  double area = 0, square = 0;
  for (const Species& each : composition.species()) {
    const double n = static_cast<double>(each.count);
    const MeanSizes sizes = MeanSizes::of(each);
    area += n * excluded_area(sizes, sizes);
    square += n * (each.extent() * each.extent());
  }
  return square > 0 ? area / square * crowding_by_packing(density, composition) : 1;
}

/// The density of the gas of needles of one length that collides as often.
inline double crowding(double density, const Composition& composition) {
  return density_by_mean(density, composition) * crowding_by_width(density, composition);
}

/// From this crowding on, cells are dearer than capsules.
inline constexpr double least_crowd_for_capsules = 2.5;
/// Spheres stay long enough in balls from here on; where they are less crowded, cells are cheapest.
inline constexpr double least_crowd_for_balls = 10;
/// So many times as large as spheres are on average may the largest be: small ones, which have
/// balls as wide, would have too many neighbours.
inline constexpr double most_over_mean_in_balls = 1.6;

/// The search asked for by name; by `auto`, the cheaper one. Density: needles per cube of the
/// longest one. Spheres keep no lists of neighbours where rows of cells
/// slide, and capsules do not pay without.
inline std::string chosen_search(const std::string& asked, double density,
                                 const Composition& composition, bool sheared = false) {
  if (asked != "auto") return asked;
  const bool spheres = composition.are_spheres();
  if (spheres && sheared) return "linked-cells";
  const double least = spheres ? least_crowd_for_balls : least_crowd_for_capsules;
  const bool alike = !spheres || mean_length(composition) * most_over_mean_in_balls >= 1;
  return alike && crowding(density, composition) >= least ? "capsules" : "linked-cells";
}

/// Whether the search asked for has sizes to choose.
inline bool has_sizes(const std::string& asked) {
  return asked != "all-pairs" && asked != "linked-lists";
}

/// Radius of capsules [L] at this crowding: larger ones have more neighbours, smaller ones are left
/// sooner.
inline double auto_capsule_radius(double crowd) {
  return std::clamp(0.6 / std::cbrt(crowd * crowd), 0.02, 1.0);
}

/// Radius of balls [L], in which spheres stay through collisions.
inline double auto_ball_radius(double crowd) {
  return std::clamp(1.3 / std::sqrt(crowd), 0.02, 1.0);
}

/// Side of the cells of capsules [L], of about 12 needles, which fill the vectors; a few fewer
/// where several threads are to have equal parts of them.
inline double auto_side_for_capsules(double density) { return std::cbrt(12 / density); }

/// Side of linked cells [L], of about 8 needles. In a dilute gas it pays to look through more, as
/// needles cross many cells from one collision to the next. In a mixture, `own` is the density of
/// the needles in these cells alone, and `crowd` that of a gas of one length in which needles
/// collide as often as they do.
inline double auto_cell_side(double own, double crowd) {
  return std::max(std::cbrt(8 / own), 1.9 / std::sqrt(crowd));
}
inline double auto_cell_side(double density) { return auto_cell_side(density, density); }

}  // namespace needlework
