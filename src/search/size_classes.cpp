#include "src/search/size_classes.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/search/choice.h"
#include "src/search/lengths.h"

namespace needlework {
namespace {

// The longest needles of a class are at most so many times as long as its needles are on average.
// Measured, 5e4 needles of two lengths, 1:3.2 to 1:20, at n L^3 = 0.1, 1 and 10, L the mean length:
// up to here one class takes 0.80 to 1.04 of the time that two take, beyond 2.6 it takes 0.99 to 20
// times that. Rods are alike.
constexpr double most_over_mean = 2.1;
// Spheres, of which a search looks at many in little time, are in one class up to so many more that
// it looks at. Measured, 2000 spheres of two sizes, 1:2 to 1:20, at packing fractions of 0.02, 0.2
// and 0.3: up to here one class takes 0.66 to 1.05 of the time that two take, and 1.0 to 4 times
// that from 250 on.
constexpr double most_seen_for_sizes = 150;

// How many spheres, so many in a volume, a search sees that looks as far as `reach` from its path,
// in cells of about eight of them.
double seen_within(double reach, double density) {
  const double side = std::cbrt(8 / density), width = 2 * reach + 1.4 * side;
  return density * width * width * (width + side);
}

// Whether bodies of these extents, `lengths` in sum, may be in one class.
bool are_alike(const Gas& gas, double longest, double lengths, double count) {
  const double mean = lengths / count;
  if (!gas.composition.are_spheres()) return longest <= most_over_mean * mean;
  const double density = count / gas.box.volume();
  return seen_within(0.5 * (longest + mean), density) - seen_within(mean, density) <=
         most_seen_for_sizes;
}

// Puts needles into classes, without what is chosen for these.
std::vector<SizeClass> grouped_by_length(const Gas& gas) {
  std::vector<double> extents;
  for (Needle i{0}; i < gas.size(); ++i) extents.push_back(2 * gas.reach(i));
  std::ranges::sort(extents, std::ranges::greater());
  std::vector<SizeClass> out;
  double lengths = 0;  // sum of those in the last class
  for (auto first = extents.begin(); first != extents.end();) {
    const double extent = *first;
    const auto last = std::find_if(first, extents.end(), [&](double e) { return e != extent; });
    const auto count = static_cast<std::size_t>(last - first);
    first = last;
    const double added = extent * static_cast<double>(count);
    const auto fits = [&](const SizeClass& group) {
      return are_alike(gas, group.longest, lengths + added,
                       static_cast<double>(group.count + count));
    };
    if (out.empty() || !fits(out.back())) {
      out.emplace_back().longest = extent;
      lengths = 0;
    }
    lengths += added;
    out.back().count += count;
  }
  return out;
}

constexpr std::size_t most_classes_by_cost = 8;
// What a search into one more class takes, as so many bodies looked at. Measured, 2000 needles of
// lognormal lengths of width 0.3 and 0.6 at n L^3 = 0.72: to split classes that this forbids takes
// 1.1 times the instructions, and not to split those that it splits 1.25 times.
constexpr double seen_for_a_class = 150;

// What all bodies look at, where classes end at these numbers of them, the longest first.
double seen_by_all(const Gas& gas, const std::vector<double>& extents,
                   const std::vector<double>& sums, const std::vector<std::size_t>& ends) {
  double out = 0;
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    const double count = static_cast<double>(end - begin), mean = (sums[end] - sums[begin]) / count;
    std::size_t other = 0;
    for (const std::size_t other_end : ends) {
      const double density = static_cast<double>(other_end - other) / gas.box.volume();
      out += count * (seen_for_a_class + seen_within(0.5 * (mean + extents[other]), density));
      other = other_end;
    }
    begin = end;
  }
  return out;
}

// The same for bodies of any sizes: a few that are far longer than the rest form classes of their
// own, as long as each search then has less to look at.
std::vector<SizeClass> grouped_by_cost(const Gas& gas) {
  std::vector<double> extents, sums{0};
  for (Needle i{0}; i < gas.size(); ++i) extents.push_back(2 * gas.reach(i));
  std::ranges::sort(extents, std::ranges::greater());
  for (const double extent : extents) sums.push_back(sums.back() + extent);
  std::vector<std::size_t> ends{extents.size()};
  double cost = seen_by_all(gas, extents, sums, ends);
  for (bool is_better = true; is_better && ends.size() < most_classes_by_cost;) {
    is_better = false;
    const std::size_t begin = ends.size() > 1 ? ends[ends.size() - 2] : 0,
                      left = extents.size() - begin;
    std::vector<std::size_t> best = ends;
    for (std::size_t part = 2; part <= 1024 && part <= left; part *= 2) {
      // Bodies of one extent stay together.
      const auto last = std::upper_bound(extents.begin(), extents.end(),
                                         extents[begin + left / part - 1], std::greater<>());
      const auto end = static_cast<std::size_t>(last - extents.begin());
      if (end == extents.size()) continue;
      std::vector<std::size_t> tried = ends;
      tried.insert(tried.end() - 1, end);
      const double its = seen_by_all(gas, extents, sums, tried);
      if (its >= cost) continue;
      cost = its;
      best = tried;
      is_better = true;
    }
    ends = best;
  }
  std::vector<SizeClass> out;
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    SizeClass& its = out.emplace_back();
    its.longest = extents[begin];
    its.count = end - begin;
    begin = end;
  }
  return out;
}

// The longest axis and the largest diameter of each class, and the means of its bodies.
std::vector<MeanSizes> measure_bodies(const Gas& gas, std::vector<SizeClass>& classes) {
  std::vector<MeanSizes> means(classes.size());
  for (Needle i{0}; i < gas.size(); ++i) {
    const double length = 2 * gas.half_length(i), diameter = 2 * gas.radius(i);
    const std::size_t n = class_of_extent(classes, 2 * gas.reach(i));
    SizeClass& its = classes[n];
    its.axis = std::max(its.axis, length);
    its.diameter = std::max(its.diameter, diameter);
    const double share = 1 / static_cast<double>(its.count);
    means[n].length += share * length;
    means[n].diameter += share * diameter;
    means[n].product += share * (length * diameter);
    means[n].square += share * (diameter * diameter);
  }
  return means;
}

// From this crowding on, capsules are cheaper than cells. A little more than in a gas of one
// length: needles in capsules search more often, and there is more than one grid to look into.
constexpr double least_for_capsules = 3;

// Needles per L^3 in a gas of one length in which the needles of this class, L long, would collide
// as often: by the areas of the bodies that two of them exclude, see crowding_by_width().
double crowding_of_class(const Gas& gas, const std::vector<SizeClass>& classes,
                         const std::vector<MeanSizes>& means, std::size_t number, double density) {
  double area = 0;
  for (std::size_t other = 0; other < classes.size(); ++other) {
    area += static_cast<double>(classes[other].count) * excluded_area(means[number], means[other]);
  }
  const double square = gas.longest * gas.longest, all = static_cast<double>(gas.size());
  return density * (area / (all * square)) * (classes[number].longest / gas.longest) *
         crowding_by_packing(density, gas.composition);
}

}  // namespace

std::vector<SizeClass> size_classes(const Gas& gas, const SearchSetup& setup, BoundingVolume kind) {
  const double density = setup.density.value_or(reduced_density(gas));
  std::vector<SizeClass> out;
  if (!setup.cell_side && !setup.capsule_radius && gas.size() > 0) {
    if (gas.has_own_bodies())
      out = grouped_by_cost(gas);
    else if (gas.composition.is_mixture())
      out = grouped_by_length(gas);
  }
  const double by_mean = density_by_mean(density, gas.composition),
               crowd = crowding(density, gas.composition),
               length = mean_length(gas.composition) * gas.longest;
  if (out.size() < 2) {
    const bool cells = kind == BoundingVolume::cell;
    out = {{gas.longest, gas.size(), kind}};
    measure_bodies(gas, out);
    SizeClass& one = out.front();
    one.cell_side = setup.cell_side.value_or(
        length * (cells ? auto_cell_side(by_mean, crowd) : auto_side_for_capsules(by_mean)));
    if (!cells) {
      one.in_balls = setup.keep_lists && gas.composition.are_spheres() && !gas.falls &&
                     !gas.shear && (crowd >= least_crowd_for_balls || setup.capsule_radius);
      one.capsule_radius = setup.capsule_radius.value_or(
          length * (one.in_balls ? auto_ball_radius(crowd) : auto_capsule_radius(crowd)));
    }
    return out;
  }
  const std::vector<MeanSizes> means = measure_bodies(gas, out);
  // Cells of few needles may be emptier than others: no grid is coarser than this, as the cells
  // that threads lock are those of the coarsest one.
  const double widest = std::max(gas.longest, length * auto_cell_side(by_mean, crowd));
  for (std::size_t n = 0; n < out.size(); ++n) {
    SizeClass& each = out[n];
    const double its_crowd = crowding_of_class(gas, out, means, n, density);
    const double share = static_cast<double>(each.count) / static_cast<double>(gas.size());
    const double cube = each.longest / gas.longest;
    const double own_density = density * share * (cube * cube * cube);
    each.kind = kind;
    if (setup.by_class) {
      // Spheres of several classes keep no lists, without which capsules do not pay.
      each.kind = gas.composition.are_spheres() || its_crowd < least_for_capsules
                      ? BoundingVolume::cell
                      : BoundingVolume::capsule;
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
