#include "src/search/bounding_volumes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/in_parallel.h"
#include "src/physics/permutation.h"
#include "src/search/choice.h"
#include "src/search/lengths.h"
#include "src/search/volumes.h"

namespace needlework {
namespace {

using kernels::Motion;

// Cells that a search may choose to have, by needles: those around a cloud are empty, and take a
// third of a kilobyte each.
constexpr double cells_per_needle = 2;

// The grid that a class wishes for.
CellGrid grid_for(const Gas& gas, const SearchSetup& setup, const SizeClass& one) {
  if (setup.cell_side) return CellGrid(gas.box.edges(), one.cell_side, one.count);
  const CellFit fit = with_volume(one.kind, [](auto volume) { return volume.fit; });
  return CellGrid(gas.box.edges(), one.cell_side, one.count, setup.count_multiples,
                  cells_per_needle, fit);
}

// The grid whose cells can be divided into those of all classes.
CellGrid coarsest(const std::vector<CellGrid>& grids, const std::array<double, 3>& box) {
  std::array<std::int32_t, 3> counts = grids.front().counts();
  for (const CellGrid& grid : grids) {
    for (int axis = 0; axis < 3; ++axis) {
      counts[axis] = std::min(counts[axis], grid.counts()[axis]);
    }
  }
  return CellGrid::of_counts(box, counts);
}

// The cells of a class: as near to what it wishes for as a division of the common grid can be.
CellGrid division_near(const Gas& gas, const CellGrid& common, const CellGrid& wished) {
  std::array<std::int32_t, 3> counts = common.counts();
  for (int axis = 0; axis < 3; ++axis) {
    const double parts = static_cast<double>(wished.counts()[axis]) / counts[axis];
    counts[axis] *= std::max(1, static_cast<std::int32_t>(parts + 0.5));
  }
  return CellGrid::of_counts(gas.box.edges(), counts);
}

void store(float (&to)[3], const Vec3d& a) {
  to[0] = static_cast<float>(a.x);
  to[1] = static_cast<float>(a.y);
  to[2] = static_cast<float>(a.z);
}

// Whether words can hold a centre in the needle's cell.
[[maybe_unused]] bool fits_words(const BoundingVolumes& volumes, Needle i, const Vec3d& centre) {
  const ClassCells& own = volumes.class_of(i);
  const kernels::WordFormat& format = own.format;
  const Vec3d r = (centre - own.grid.corner(volumes.places[i].cell)) * volumes.frame.per_length;
  return format.holds(r.x) && format.holds(r.y) && format.holds(r.z);
}

}  // namespace

BoundingVolumes::BoundingVolumes(const Gas& all, const SearchSetup& setup, BoundingVolume kind)
    : gas(all),
      frame(all),
      distances(all, frame.per_length),
      sizes(size_classes(all, setup, kind)),
      places(all.size()),
      motions(all.size()),
      are_spheres(all.composition.are_spheres()) {
  std::vector<CellGrid> wished;
  for (const SizeClass& each : sizes) wished.push_back(grid_for(gas, setup, each));
  const bool one = wished.size() == 1;
  grid = one ? wished.front() : coarsest(wished, gas.box.edges());
  for (std::size_t c = 0; c < wished.size(); ++c) {
    const CellGrid its_grid = one ? grid : division_near(gas, grid, wished[c]);
    classes.push_back(std::make_unique<ClassCells>(frame, sizes[c], its_grid));
    const ClassCells& made = *classes.back();
    // What words round is far less than what Phase adds to the length of a needle, unless cells are
    // very much longer than that.
    const double rounding = one ? 0 : 8 * made.format.step() / frame.per_length;
    radius = std::max({radius, made.radius, made.ahead});
    drift = std::max(drift, std::max(made.overlap, made.radius) + rounding);
  }
  moves_plainly_ = !gas.shear && !frame.falls;
  if (!gas.shear) return;
  rows = std::make_unique<SlidingRows>(gas, grid);
  wraps.resize(gas.size());
}

bool BoundingVolumes::place(Needle i, Time now, double half_length) {
  make_fit(now);
  return moves_plainly_ ? place_one<false>(i, now, half_length)
         : rows         ? place_in_row(i, now, half_length)
                        : place_one<true>(i, now, half_length);
}

template <bool falls>
inline bool BoundingVolumes::place_one(Needle i, Time now, double half_length) {
  const Record& record = gas.records[i];
  return place_flight<falls>(i, record.flight, gas.clock.difference(now, record.time), now,
                             half_length);
}

[[gnu::noinline]] bool BoundingVolumes::place_in_row(Needle i, Time now, double half_length) {
  const Record& record = gas.records[i];
  const double elapsed = gas.clock.difference(now, record.time);
  rows->set_now(now);
  const SlidingRows::Seen seen = rows->see(record, elapsed, class_of(i).ahead);
  wraps[i] = seen.boxes;
  return frame.falls ? place_flight<true>(i, seen.flight, elapsed, now, half_length)
                     : place_flight<false>(i, seen.flight, elapsed, now, half_length);
}

template <bool falls>
[[gnu::always_inline]] inline bool BoundingVolumes::place_flight(Needle i,
                                                                 const kernels::Flight& flight,
                                                                 double elapsed, Time now,
                                                                 double half_length) {
  const MotionFrom<FreeFlight> motion{frame.flight_of<falls>(flight), elapsed};
  const Vec3d centre = motion.centre();
  const MotionFrame::Path path = frame.path_of<falls>(centre, motion.velocity(), now);
  ClassCells& own = class_of(i);
  return with_volume(own.kind, [&]<class Volume>(Volume) {
    const Placement placed =
        Volume::template place<falls>(own, frame, PresentNeedle{motion, centre, path, half_length});
    const bool crosses = enter(own, i, placed.cell);
    places[i].next_event = gas.clock.add(now, placed.stay);
    motions[i].half = static_cast<float>(half_length * frame.per_length);
    assert(fits_words(*this, i, placed.centre));
    write_entry<Volume>(own, i, placed.centre, placed.direction, now);
    set_motion(i, elapsed, path, now);
    return crosses;
  });
}

void BoundingVolumes::prepare(Time now, int threads) {
  // Early, so that there is always some time ahead.
  if (frame.per_time == 0 || frame.since_base(now) > 0.75 * frame.longest_time)
    rebase(now, threads);
}

void BoundingVolumes::renumber(const std::vector<Needle>& ranks) {
  const std::vector<Needle> order = ranks_of(ranks);
  permute(places, order);
  permute(motions, order);
  if (rows) permute(wraps, order);
  distances.renumber(order);
  for (const auto& each : classes) each->cells.renumber(ranks);
}

// Chooses the unit of time and the origin of times in blocks and motions.
void BoundingVolumes::begin_again(Time now) {
  begin_frame(now);
  if (rows) rows->begin_again(now);
}

void BoundingVolumes::begin_frame(Time now) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& each : classes) least = std::min(least, each->most_fallen);
  frame.begin(now, least);
}

// Of needles that stay in their cells.
void BoundingVolumes::carry_rows(Time now) {
  const std::vector<std::int32_t> boxes = rows->carry(now);
  for (Needle i{0}; i < gas.size(); ++i) {
    const std::int32_t row = grid.wrap(places[i].cell[1], 1);
    wraps[i] = wraps[i] + Shift{boxes[static_cast<std::size_t>(row)], 0, 0};
  }
}

// Does the same for needles that stay where they are, before times grow so long that floats lose
// digits of them.
void BoundingVolumes::rebase(Time now, int threads) {
  begin_frame(now);
  if (rows) carry_rows(now);
  kernels::in_parallel(gas.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (Needle i(begin); i < end; ++i) {
      if (!places[i].is_entered()) continue;
      const Record& record = gas.records[i];
      const double elapsed = gas.clock.difference(now, record.time);
      const kernels::Flight flight =
          rows ? rows->see_from(places[i].cell[1], wraps[i], record, elapsed) : record.flight;
      const MotionFrom<FreeFlight> present{FreeFlight(flight, gas.falls ? &gas.gravity : nullptr),
                                           elapsed};
      const MotionFrame::Path path = frame.path_of(present.centre(), present.velocity(), now);
      set_motion(i, present.start, path, now);
      ClassCells& own = class_of(i);
      with_volume(own.kind, [&]<class Volume>(Volume) {
        // The centre fits its words, except that of a needle that has just collided and was taken
        // to the other side of the box: it is placed again before any needle searches.
        if constexpr (Volume::timed) {
          write_entry<Volume>(own, i, path.centre,
                              path.velocity * (frame.per_length / frame.per_time), now);
        }
      });
    }
  });
}

void BoundingVolumes::set_motion(Needle i, double elapsed, const MotionFrame::Path& path,
                                 Time now) {
  const kernels::Flight& flight = gas.records[i].flight;
  const double unit_of_time = 1 / frame.per_time;
  Motion& out = motions[i];
  const Vec3d corner = class_of(i).grid.corner(places[i].cell);
  store(out.r, (path.centre - corner) * frame.per_length);
  store(out.v, path.velocity * (frame.per_length * unit_of_time));
  out.time = static_cast<float>(frame.since_base(now));
  out.until = frame.rounded_up(places[i].next_event);
  if (are_spheres) return;
  const SineCosine<double> sc = sine_cosine(flight.omega * elapsed);
  store(out.u, flight.u * sc.cosine + flight.p * sc.sine);
  store(out.p, flight.p * sc.cosine - flight.u * sc.sine);
  out.omega = static_cast<float>(flight.omega * unit_of_time);
}

bool BoundingVolumes::enter(ClassCells& own, Needle i, const Cell& cell) {
  Place& place = places[i];
  const bool entered = place.is_entered();
  if (entered && same(place.cell, cell)) return false;
  const auto index = static_cast<std::uint32_t>(own.grid.index_of(cell));
  if (entered) {
    const auto old = static_cast<std::uint32_t>(own.grid.index_of(place.cell));
    place.cell = cell;
    if (old == index) return false;
    const Needle moved = own.cells.leave(old, place.slot);
    if (moved != i) places[moved].slot = place.slot;
  }
  place.cell = cell;
  place.slot = own.cells.enter(index, i);
  return entered;
}

Shift BoundingVolumes::boxes_between_rows(Needle i, Needle j, const Cell& seen,
                                          const Shift& shift) const {
  const std::int32_t slid = rows->beside(places[i].cell[1], seen[1]).boxes;
  return shift + Shift{slid, 0, 0} + wraps[i] - wraps[j];
}

// What contains the needle's cell.
Cell BoundingVolumes::cell_around(Needle i) const {
  const std::array<std::int32_t, 3> all = class_of(i).grid.counts(), common = grid.counts();
  Cell out = places[i].cell;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t parts = all[axis] / common[axis];
    out[axis] = (out[axis] - (out[axis] < 0 ? parts - 1 : 0)) / parts;
  }
  return out;
}

}  // namespace needlework
