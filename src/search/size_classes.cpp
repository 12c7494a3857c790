#include "src/search/size_classes.h"

#include <algorithm>
#include <numeric>

#include "src/search/choice.h"
#include "src/search/lengths.h"

namespace needlework {
namespace {

// Lengths in one class differ by this factor at most. Measured, 1e5 needles, half of each length:
// in one class those of 1:2 take 0.88 to 0.95 of the time that they take in two; at 1:4 one class
// and two are equal, and 1:20 takes less in two, the less the fewer the long needles.
constexpr double most_unequal = 3;

std::vector<std::size_t> counts_of_species(const Gas& gas) {
  std::vector<std::size_t> out(gas.composition.size());
  for (const Record& record : gas.records) ++out[record.species];
  return out;
}

// Puts species into classes, without what is chosen for these.
SizeClasses grouped_by_length(const Gas& gas) {
  const std::vector<Species>& species = gas.composition.species();
  std::vector<std::size_t> by_length(species.size());
  std::iota(by_length.begin(), by_length.end(), std::size_t{0});
  std::stable_sort(by_length.begin(), by_length.end(), [&](std::size_t a, std::size_t b) {
    return species[a].extent() > species[b].extent();
  });
  const std::vector<std::size_t> counts = counts_of_species(gas);
  SizeClasses out;
  out.of_species.resize(species.size());
  for (const std::size_t s : by_length) {
    if (counts[s] == 0) continue;
    const double extent = 2 * gas.bodies[s].reach();
    if (out.all.empty() || extent * most_unequal < out.all.back().longest) {
      out.all.emplace_back().longest = extent;
    }
    SizeClass& last = out.all.back();
    last.count += counts[s];
    last.axis = std::max(last.axis, species[s].length);
    out.of_species[s] = static_cast<std::uint8_t>(out.all.size() - 1);
  }
  return out;
}

// From this crowding on, capsules are cheaper than cells. A little more than in a gas of one
// length: needles in capsules search more often, and there is more than one grid to look into.
constexpr double least_for_capsules = 3;

// Needles per L^3 in a gas of one length in which needles of this class, L long, would collide as
// often.
double crowding_of_class(const Gas& gas, double density, double length) {
  const double by_longest = mean_length(gas.composition), share = length / gas.longest;
  return density * by_longest * (share * share) * crowding_by_width(density, gas.composition);
}

}  // namespace

SizeClasses size_classes(const Gas& gas, const SearchSetup& setup, BoundingVolume kind) {
  const double density = setup.density.value_or(reduced_density(gas));
  SizeClasses out;
  if (gas.composition.is_mixture() && !setup.cell_side && !setup.capsule_radius)
    out = grouped_by_length(gas);
  const double by_mean = density_by_mean(density, gas.composition),
               crowd = crowding(density, gas.composition),
               length = mean_length(gas.composition) * gas.longest;
  if (out.all.size() < 2) {
    const bool cells = kind == BoundingVolume::cell;
    out.all = {{gas.longest, gas.size(), kind}};
    out.of_species.assign(gas.composition.size(), 0);
    SizeClass& one = out.all.front();
    for (const Species& each : gas.composition.species()) {
      one.axis = std::max(one.axis, each.length);
    }
    one.cell_side = setup.cell_side.value_or(
        length * (cells ? auto_cell_side(by_mean, crowd) : auto_side_for_capsules(by_mean)));
    if (!cells) {
      one.in_balls = setup.keep_lists && gas.composition.are_spheres() && !gas.falls &&
                     (crowd >= least_crowd_for_balls || setup.capsule_radius);
      one.capsule_radius = setup.capsule_radius.value_or(
          length * (one.in_balls ? auto_ball_radius(crowd) : auto_capsule_radius(crowd)));
    }
    return out;
  }
  // Cells of few needles may be emptier than others: no grid is coarser than this, as the cells
  // that threads lock are those of the coarsest one.
  const double widest = std::max(gas.longest, length * auto_cell_side(by_mean, crowd));
  for (SizeClass& each : out.all) {
    const double its_crowd = crowding_of_class(gas, density, each.longest);
    const double share = static_cast<double>(each.count) / static_cast<double>(gas.size());
    const double cube = each.longest / gas.longest;
    const double own_density = density * share * (cube * cube * cube);
    each.kind = kind;
    if (setup.by_class) {
      each.kind = its_crowd < least_for_capsules ? BoundingVolume::cell : BoundingVolume::capsule;
    }
    if (each.kind == BoundingVolume::cell) {
      each.cell_side = each.longest * auto_cell_side(own_density, its_crowd);
    } else {
      each.cell_side = each.longest * auto_side_for_capsules(own_density);
      each.capsule_radius = each.longest * auto_capsule_radius(its_crowd);
    }
    each.cell_side = std::min(each.cell_side, widest);
  }
  return out;
}

}  // namespace needlework
