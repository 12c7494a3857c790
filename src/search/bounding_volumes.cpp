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

// The grid that a class wishes for. Cells that slide in rows are by `tall` longer across them than
// others, and shorter along x, as each row takes a look of its own.
CellGrid grid_for(const Gas& gas, const SearchSetup& setup, const SizeClass& one) {
  if (setup.cell_side) return CellGrid(gas.box.edges(), one.cell_side, one.count);
  return with_volume(one.kind, [&](auto volume) {
    Vector edges = gas.box.edges();
    const double tall = gas.shear ? volume.tall : 1;
    edges[0] *= tall;
    edges[1] /= tall;
    const CellGrid out(edges, one.cell_side, one.count, setup.count_multiples, cells_per_needle,
                       volume.fit);
    return gas.shear ? CellGrid::of_counts(gas.box.edges(), out.counts()) : out;
  });
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
  if (gas.shear)
    grid = CellGrid::of_counts(gas.box.edges(), {1, grid.counts()[1], grid.counts()[2]});
  for (std::size_t c = 0; c < wished.size(); ++c) {
    const CellGrid its_grid = one ? wished[c] : division_near(gas, grid, wished[c]);
    classes.push_back(std::make_unique<ClassCells>(frame, sizes[c], its_grid));
    const ClassCells& made = *classes.back();
    // What words round is far less than what Phase adds to the length of a needle, unless cells are
    // very much longer than that.
    const double rounding = one ? 0 : 8 * made.format.step() / frame.per_length;
    radius = std::max({radius, made.radius, made.ahead});
    drift = std::max(drift, std::max(made.overlap, made.radius) + rounding);
  }
  moves_plainly_ = !gas.shear && !frame.falls;
  is_of_one_grid_ = one && !gas.shear;
  if (gas.shear) wraps.resize(gas.size());
}

bool BoundingVolumes::place(Needle i, Time now, double half_length) {
  make_fit(now);
  return moves_plainly_ ? place_one<false>(i, now, half_length)
         : gas.shear    ? place_in_row(i, now, half_length)
                        : place_one<true>(i, now, half_length);
}

template <bool falls>
inline bool BoundingVolumes::place_one(Needle i, Time now, double half_length) {
  const Record& record = gas.records[i];
  const double elapsed = gas.clock.difference(now, record.time);
  const PresentNeedle needle = present_needle<falls>(record.flight, elapsed, now, half_length);
  ClassCells& own = class_of(i);
  return with_volume(own.kind, [&]<class Volume>(Volume) {
    const Placement placed = Volume::template place<falls>(own, frame, needle);
    return enter_placed<Volume>(own, i, needle, placed, now);
  });
}

template <bool falls>
[[gnu::always_inline]] inline PresentNeedle BoundingVolumes::present_needle(
    const kernels::Flight& flight, double elapsed, Time now, double half_length) const {
  const MotionFrom<FreeFlight> motion{frame.flight_of<falls>(flight), elapsed};
  const Vec3d centre = motion.centre();
  return {motion, centre, frame.path_of<falls>(centre, motion.velocity(), now), half_length};
}

template <class Volume>
[[gnu::always_inline]] inline bool BoundingVolumes::enter_placed(ClassCells& own, Needle i,
                                                                 const PresentNeedle& needle,
                                                                 const Placement& placed,
                                                                 Time now) {
  const bool crosses = enter(own, i, placed.cell);
  places[i].next_event = gas.clock.add(now, placed.stay);
  motions[i].half = static_cast<float>(needle.half_length * frame.per_length);
  if (own.cells.differ())
    own.cells.set_reach(places[i].slot, Volume::reach_of(motions[i].half, distances.half_width(i)));
  assert(fits_words(*this, i, placed.centre));
  write_entry<Volume>(own, i, placed.centre, placed.direction, now);
  set_motion(i, needle.motion.start, needle.path, now);
  return crosses;
}

[[gnu::noinline]] bool BoundingVolumes::place_in_row(Needle i, Time now, double half_length) {
  return with_volume(class_of(i).kind, [&]<class Volume>(Volume) {
    return frame.falls ? place_in_row_as<Volume, true>(i, now, half_length)
                       : place_in_row_as<Volume, false>(i, now, half_length);
  });
}

// In the row that holds the cell in which it is placed. That of a capsule depends on how fast its
// row flies: the capsule of one that finds no such row is where it is now.
template <class Volume, bool falls>
bool BoundingVolumes::place_in_row_as(Needle i, Time now, double half_length) {
  ClassCells& own = class_of(i);
  const Record& record = gas.records[i];
  const SlidingRows::Present rows(*own.rows, now);
  const double elapsed = gas.clock.difference(now, record.time);
  double ahead = std::copysign(own.ahead, gas.motion(record).velocity(elapsed).y);
  for (int turn = 0;; ++turn) {
    const SlidingRows::Seen seen = rows.see(record, elapsed, ahead);
    const PresentNeedle needle = present_needle<falls>(seen.flight, elapsed, now, half_length);
    Placement placed = turn < 2 ? Volume::template place<falls>(own, frame, needle)
                                : Volume::template place_here<falls>(own, frame, needle);
    if (placed.cell[1] != seen.row) {
      ahead = turn == 0 ? placed.centre.y - needle.centre.y : 0;
      continue;
    }
    wraps[i] = seen.boxes;
    // In so long, the next row gets no farther than to the next cells but one.
    placed.stay = std::min(placed.stay, 2 * own.grid.sides()[0] / std::abs(own.rows->slide()));
    return enter_placed<Volume>(own, i, needle, placed, now);
  }
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
  if (gas.shear) permute(wraps, order);
  distances.renumber(order);
  for (const auto& each : classes) each->cells.renumber(ranks);
}

// Chooses the unit of time and the origin of times in blocks and motions.
void BoundingVolumes::begin_again(Time now) {
  begin_frame(now);
  for (const auto& each : classes) {
    if (each->rows) each->rows->begin_again(now);
  }
}

void BoundingVolumes::begin_frame(Time now) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& each : classes) least = std::min(least, each->most_fallen);
  frame.begin(now, least);
}

// Of needles that stay in their cells.
void BoundingVolumes::carry_rows(Time now) {
  for (const auto& each : classes) {
    const std::vector<std::int32_t> boxes = each->rows->carry(now);
    for (Needle i{0}; i < gas.size(); ++i) {
      if (&class_of(i) != each.get()) continue;
      const auto row = static_cast<std::size_t>(places[i].cell[1]);
      wraps[i] = wraps[i] + Shift{boxes[row], 0, 0};
    }
  }
}

// Does the same for needles that stay where they are, before times grow so long that floats lose
// digits of them.
void BoundingVolumes::rebase(Time now, int threads) {
  begin_frame(now);
  if (gas.shear) carry_rows(now);
  kernels::in_parallel(gas.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (Needle i(begin); i < end; ++i) {
      if (!places[i].is_entered()) continue;
      const Record& record = gas.records[i];
      const double elapsed = gas.clock.difference(now, record.time);
      ClassCells& own = class_of(i);
      const kernels::Flight flight =
          own.rows ? SlidingRows::Present(*own.rows, now)
                         .see_from(places[i].cell[1], wraps[i], record, elapsed)
                   : record.flight;
      const MotionFrom<FreeFlight> present{FreeFlight(flight, gas.falls ? &gas.gravity : nullptr),
                                           elapsed};
      const MotionFrame::Path path = frame.path_of(present.centre(), present.velocity(), now);
      set_motion(i, present.start, path, now);
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

// What contains the needle's cell.
Cell BoundingVolumes::cell_around(Needle i) const {
  const std::array<std::int32_t, 3> all = class_of(i).grid.counts(), common = grid.counts();
  Cell out = places[i].cell;
  if (gas.shear) out = class_of(i).grid.image_of(out, {0, wraps[i][1], wraps[i][2]});
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t parts = all[axis] / common[axis];
    out[axis] = (out[axis] - (out[axis] < 0 ? parts - 1 : 0)) / parts;
  }
  return out;
}

}  // namespace needlework
