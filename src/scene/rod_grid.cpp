#include "src/scene/rod_grid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "kernels/rod_contact.h"
#include "kernels/rod_distance.h"

namespace needlework {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

Vec3d vector_from(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

kernels::Flight at_rest(const std::array<double, 3>& centre,
                        const std::array<double, 3>& director) {
  kernels::Flight out{};
  out.r = vector_from(centre);
  out.u = vector_from(director);
  out.u = out.u * (1 / std::sqrt(dot(out.u, out.u)));
  return out;
}

// Of axes whose centres are `apart`: in double where that tells on which side of 0 it is.
double gap_of(const kernels::RodPair& pair, const Vec3d& apart, double reach) {
  kernels::RodSample<double> at{};
  at.r = apart;
  at.u[0] = pair.first->u;
  at.u[1] = pair.second->u;
  at.x = cross(at.u[0], at.u[1]);
  const double half[2] = {pair.half_first, pair.half_second};
  kernels::set_nearest(at, half);
  const double gap = std::sqrt(at.square) - pair.distance;
  return std::abs(gap) > 0x1p-30 * reach ? gap : kernels::rod_gap(pair, DoubleDouble());
}

}  // namespace

RodGrid::RodGrid(const Composition& composition, std::span<const RodShape> rods, const Box& box)
    : composition_(composition), box_(box) {
  std::vector<double> extents;
  for (const RodShape& rod : rods) extents.push_back(rod.extent());
  std::ranges::sort(extents, std::ranges::greater());
  for (auto first = extents.begin(); first != extents.end();) {
    Level& level = levels_.emplace_back();
    level.extent = *first;
    const auto last = std::find_if(first, extents.end(),
                                   [&](double extent) { return extent <= 0.5 * level.extent; });
    const auto count = static_cast<double>(last - first);
    first = last;
    // About one rod in each cell, and none shorter than what is in contact.
    const double side = std::max(level.extent * (1 + 0x1p-20), std::cbrt(box.volume() / count));
    std::int64_t cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      level.counts[axis] = std::max<std::int64_t>(
          1, static_cast<std::int64_t>(std::min(box.edge(axis) / side, 1e6)));
      cells *= level.counts[axis];
    }
    level.first.assign(static_cast<std::size_t>(cells), none);
  }
  rods_.reserve(rods.size());
}

RodGrid::Level& RodGrid::level_of(const RodShape& rod) {
  const auto found = std::ranges::find_if(
      levels_, [&](const Level& level) { return rod.extent() > 0.5 * level.extent; });
  return *found;
}

RodGrid::Cell RodGrid::cell_of(const Level& level, const Vec3d& r) const {
  const std::array<double, 3> place = box_.wrap({r.x, r.y, r.z}).place;
  Cell out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double share = place[axis] / box_.edge(axis);
    const auto cell = static_cast<std::int64_t>(std::clamp(share, 0.0, 1.0) *
                                                static_cast<double>(level.counts[axis]));
    out[axis] = std::min(cell, level.counts[axis] - 1);
  }
  return out;
}

std::size_t RodGrid::Level::index_of(const Cell& cell) const {
  return static_cast<std::size_t>((cell[2] * counts[1] + cell[1]) * counts[0] + cell[0]);
}

template <class Visit>
void RodGrid::for_each_near(const Level& level, const Vec3d& r, double reach,
                            const Visit& visit) const {
  const Cell cell = cell_of(level, r);
  // Along each axis the first cell and how many; all of them, where they come round.
  Cell first, count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t all = level.counts[axis];
    // One more than that many sides, as rounding may put a centre into the next cell.
    const auto away = static_cast<std::int64_t>(reach * (1 + 0x1p-20) / box_.edge(axis) *
                                                static_cast<double>(all)) +
                      1;
    first[axis] = cell[axis] - away;
    count[axis] = 2 * away + 1;
    if (!box_.is_periodic(axis)) {
      const std::int64_t last = std::min(all - 1, cell[axis] + away);
      first[axis] = std::max<std::int64_t>(0, first[axis]);
      count[axis] = last - first[axis] + 1;
    } else if (count[axis] >= all) {
      first[axis] = 0;
      count[axis] = all;
    }
  }
  // The row of boxes above, and that below, may have slid along x.
  const double slid = box_.row_above().offset.hi;
  if (slid != 0 && count[1] == level.counts[1]) {
    first[0] = 0;
    count[0] = level.counts[0];
  }
  const auto first_in = [&](std::int64_t y) {
    const double rows = y < 0 ? -1 : y >= level.counts[1] ? 1 : 0;
    if (slid == 0 || rows == 0) return first[0];
    return first[0] - cell[0] + cell_of(level, {r.x - rows * slid, r.y, r.z})[0];
  };
  Cell at;
  for (std::int64_t z = 0; z < count[2]; ++z) {
    at[2] = (first[2] + z + level.counts[2]) % level.counts[2];
    for (std::int64_t y = 0; y < count[1]; ++y) {
      at[1] = (first[1] + y + level.counts[1]) % level.counts[1];
      const std::int64_t first_x = first_in(first[1] + y);
      for (std::int64_t x = 0; x < count[0]; ++x) {
        at[0] = (first_x + x + level.counts[0]) % level.counts[0];
        for (std::uint32_t i = level.first[level.index_of(at)]; i != none; i = rods_[i].next) {
          visit(i);
        }
      }
    }
  }
}

template <class Visit>
void RodGrid::visit_overlaps(const std::array<double, 3>& centre,
                             const std::array<double, 3>& director, const RodShape& rod,
                             double tolerance, Visit&& visit) const {
  const kernels::Flight flight = at_rest(centre, director);
  const auto compare = [&](std::uint32_t i) {
    const Rod& other = rods_[i];
    if (!composition_.exclude(rod.species, other.shape.species)) return;
    const Vec3d apart = flight.r - other.flight.r;
    const Vec3dd shift = box_.image<DoubleDouble>(box_.nearest(apart)).place;
    const Vec3d nearest = apart - to_double(shift);
    const double distance = 0.5 * (rod.diameter + other.shape.diameter);
    const double reach = 0.5 * (rod.length + other.shape.length) + distance;
    if (dot(nearest, nearest) >= reach * reach) return;
    kernels::RodPair pair;
    pair.first = &flight;
    pair.second = &other.flight;
    pair.shift = shift;
    pair.half_first = 0.5 * rod.length;
    pair.half_second = 0.5 * other.shape.length;
    pair.distance = distance;
    const double gap = gap_of(pair, nearest, reach);
    if (gap < -tolerance) visit(Overlap{i, distance + gap, distance});
  };
  for (const Level& level : levels_) {
    if (level.entered == 0) continue;
    for_each_near(level, flight.r, 0.5 * (rod.extent() + level.extent), compare);
  }
}

std::optional<RodGrid::Overlap> RodGrid::overlap(const std::array<double, 3>& centre,
                                                 const std::array<double, 3>& director,
                                                 const RodShape& rod, double tolerance) const {
  std::optional<Overlap> first;
  visit_overlaps(centre, director, rod, tolerance, [&](const Overlap& overlap) {
    if (!first || overlap.other < first->other) first = overlap;
  });
  return first;
}

std::vector<RodGrid::Overlap> RodGrid::overlaps(const std::array<double, 3>& centre,
                                                const std::array<double, 3>& director,
                                                const RodShape& rod, double tolerance) const {
  std::vector<Overlap> all;
  visit_overlaps(centre, director, rod, tolerance,
                 [&](const Overlap& overlap) { all.push_back(overlap); });
  return all;
}

void RodGrid::enter(const std::array<double, 3>& centre, const std::array<double, 3>& director,
                    const RodShape& shape) {
  const auto i = static_cast<std::uint32_t>(rods_.size());
  Rod& rod = rods_.emplace_back(Rod{at_rest(centre, director), shape, none});
  Level& level = level_of(shape);
  std::uint32_t& first = level.first[level.index_of(cell_of(level, rod.flight.r))];
  rod.next = first;
  first = i;
  ++level.entered;
}

}  // namespace needlework
