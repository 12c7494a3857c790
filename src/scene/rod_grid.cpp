#include "src/scene/rod_grid.h"

#include <algorithm>
#include <cmath>
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

RodGrid::RodGrid(const Composition& composition, const std::array<double, 3>& box,
                 const std::array<bool, 3>& periodic, std::size_t rods)
    : composition_(composition), box_(box), periodic_(periodic) {
  // About one rod in each cell, and none shorter than what is in contact.
  const double volume = box[0] * box[1] * box[2];
  const double side =
      std::max(composition.longest() * (1 + 0x1p-20),
               std::cbrt(volume / static_cast<double>(std::max<std::size_t>(1, rods))));
  std::int64_t cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts_[axis] =
        std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(box[axis] / side, 1e6)));
    cells *= counts_[axis];
  }
  first_.assign(static_cast<std::size_t>(cells), none);
  rods_.reserve(rods);
}

std::array<std::int64_t, 3> RodGrid::cell_of(const Vec3d& r) const {
  const double place[3] = {r.x, r.y, r.z};
  std::array<std::int64_t, 3> out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double share = place[axis] / box_[axis];
    if (periodic_[axis]) share -= std::floor(share);
    const auto cell =
        static_cast<std::int64_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(counts_[axis]));
    out[axis] = std::min(cell, counts_[axis] - 1);
  }
  return out;
}

std::size_t RodGrid::index_of(const std::array<std::int64_t, 3>& cell) const {
  return static_cast<std::size_t>((cell[2] * counts_[1] + cell[1]) * counts_[0] + cell[0]);
}

template <class Visit>
void RodGrid::visit_overlaps(const std::array<double, 3>& centre,
                             const std::array<double, 3>& director, SpeciesIndex species,
                             double tolerance, Visit&& visit) const {
  const kernels::Flight flight = at_rest(centre, director);
  const std::array<std::int64_t, 3> cell = cell_of(flight.r);
  // The cells around along each axis, each once.
  std::array<std::array<std::int64_t, 3>, 3> near{};
  std::array<std::size_t, 3> count{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::int64_t n = cell[axis] - 1; n <= cell[axis] + 1; ++n) {
      const std::int64_t all = counts_[axis];
      if (!periodic_[axis] && (n < 0 || n >= all)) continue;
      const std::int64_t wrapped = (n + all) % all;
      const auto end = near[axis].begin() + static_cast<std::ptrdiff_t>(count[axis]);
      if (std::find(near[axis].begin(), end, wrapped) == end) near[axis][count[axis]++] = wrapped;
    }
  }
  const auto image = [&](double apart, std::size_t axis) {
    return periodic_[axis] ? box_[axis] * std::nearbyint(apart / box_[axis]) : 0;
  };
  const Species& its = composition_[species];
  for (std::size_t z = 0; z < count[2]; ++z) {
    for (std::size_t y = 0; y < count[1]; ++y) {
      for (std::size_t x = 0; x < count[0]; ++x) {
        for (std::uint32_t i = first_[index_of({near[0][x], near[1][y], near[2][z]})]; i != none;
             i = rods_[i].next) {
          const Rod& other = rods_[i];
          const Vec3d apart = flight.r - other.flight.r;
          const Vec3d shift{image(apart.x, 0), image(apart.y, 1), image(apart.z, 2)};
          const Vec3d nearest = apart - shift;
          const Species& others = composition_[other.species];
          const double distance = composition_.contact_distance(species, other.species);
          const double reach = 0.5 * (its.length + others.length) + distance;
          if (dot(nearest, nearest) >= reach * reach) continue;
          kernels::RodPair pair;
          pair.first = &flight;
          pair.second = &other.flight;
          pair.shift = to_double_double(shift);
          pair.half_first = 0.5 * its.length;
          pair.half_second = 0.5 * others.length;
          pair.distance = distance;
          const double gap = gap_of(pair, nearest, reach);
          if (gap < -tolerance) visit(Overlap{i, distance + gap, distance});
        }
      }
    }
  }
}

std::optional<RodGrid::Overlap> RodGrid::overlap(const std::array<double, 3>& centre,
                                                 const std::array<double, 3>& director,
                                                 SpeciesIndex species, double tolerance) const {
  std::optional<Overlap> first;
  visit_overlaps(centre, director, species, tolerance, [&](const Overlap& overlap) {
    if (!first || overlap.other < first->other) first = overlap;
  });
  return first;
}

std::vector<RodGrid::Overlap> RodGrid::overlaps(const std::array<double, 3>& centre,
                                                const std::array<double, 3>& director,
                                                SpeciesIndex species, double tolerance) const {
  std::vector<Overlap> all;
  visit_overlaps(centre, director, species, tolerance,
                 [&](const Overlap& overlap) { all.push_back(overlap); });
  return all;
}

void RodGrid::enter(const std::array<double, 3>& centre, const std::array<double, 3>& director,
                    SpeciesIndex species) {
  const auto i = static_cast<std::uint32_t>(rods_.size());
  Rod& rod = rods_.emplace_back(Rod{at_rest(centre, director), species, none});
  std::uint32_t& first = first_[index_of(cell_of(rod.flight.r))];
  rod.next = first;
  first = i;
}

}  // namespace needlework
