#include "src/search/bounding_volumes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/in_parallel.h"
#include "kernels/power_of_two.h"
#include "src/physics/permutation.h"
#include "src/search/choice.h"
#include "src/search/lengths.h"
#include "src/search/neighbour_lists.h"

namespace needlework {
namespace {

using kernels::Motion;
using kernels::NeedleBlock;

// A needle stays in its cell until it is out of it by this share of the cell's side: one that goes
// to and fro across a border, or crosses a corner, need not be placed again so often.
constexpr double overlap_of_side = 0.2;
// So far the falling frame of motions moves, by sides of cells or lengths of needles, before it is
// brought to rest again.
constexpr double fallen_of_side = 0.125;
// A sphere in less room than this share of the square of its ball's radius gets another ball.
constexpr double least_room = 0x1p-10;
// Cells that a search may choose to have, by needles: those around a cloud are empty, and take a
// third of a kilobyte each.
constexpr double cells_per_needle = 2;

// The grid that a class wishes for.
CellGrid grid_for(const Gas& gas, const SearchSetup& setup, const SizeClass& one) {
  if (setup.cell_side) return CellGrid(gas.box.edges(), one.cell_side, one.count);
  return CellGrid(gas.box.edges(), one.cell_side, one.count, setup.count_multiples,
                  cells_per_needle,
                  one.kind == BoundingVolume::cell ? CellFit::at_least : CellFit::nearest);
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

// Whether lists of neighbours can hold by how many cells two balls that overlap are apart.
bool reaches_few_cells(const Gas& gas, const ClassCells& balls) {
  const auto sides = balls.grid.sides();
  const double reach = gas.composition.widest() + 2 * balls.radius;
  return reach < NeighbourLists::farthest * std::min({sides[0], sides[1], sides[2]});
}

void store(float (&to)[3], const Vec3d& a) {
  to[0] = static_cast<float>(a.x);
  to[1] = static_cast<float>(a.y);
  to[2] = static_cast<float>(a.z);
}

}  // namespace

ClassCells::ClassCells(const Gas& gas, const SizeClass& sizes, const CellGrid& its_grid,
                       double per_length)
    : kind(sizes.kind),
      radius(sizes.capsule_radius),
      in_capsules(static_cast<float>(radius * per_length)),
      longest_half(static_cast<float>(0.5 * sizes.axis * per_length)),
      widest_half(static_cast<float>(0.5 * sizes.diameter * per_length)),
      grid(its_grid),
      cells(grid.size(), sizes.count) {
  const auto sides = grid.sides();
  if (kind == BoundingVolume::cell) {
    overlap = overlap_of_side * std::min({sides[0], sides[1], sides[2]});
  }
  const double side = std::max({sides[0], sides[1], sides[2]});
  if (gas.falls) most_fallen = fallen_of_side * std::min(side, sizes.longest);
  const double low = -overlap - most_fallen, widest = side + overlap + most_fallen;
  format = kernels::WordFormat::holding(low * per_length, widest * per_length);
  margin = kernels::margin_of_lengths(widest * per_length);
}

BoundingVolumes::BoundingVolumes(const Gas& all, const SearchSetup& setup, BoundingVolume kind)
    : gas(all),
      falls(all.falls),
      walled(!all.box.is_periodic()),
      per_length(1 / needlework::unit_of_length(all)),
      places(all.size()),
      motions(all.size()) {
  sizes = size_classes(gas, setup, kind);
  std::vector<CellGrid> wished;
  for (const SizeClass& each : sizes) wished.push_back(grid_for(gas, setup, each));
  const bool one = wished.size() == 1;
  grid = one ? wished.front() : coarsest(wished, gas.box.edges());
  for (std::size_t c = 0; c < wished.size(); ++c) {
    const CellGrid its_grid = one ? grid : division_near(gas, grid, wished[c]);
    classes.push_back(std::make_unique<ClassCells>(gas, sizes[c], its_grid, per_length));
    const ClassCells& made = *classes.back();
    // What words round is far less than what Phase adds to the length of a needle, unless cells are
    // very much longer than that.
    const double rounding = one ? 0 : 8 * made.format.step() / per_length;
    radius = std::max(radius, made.radius);
    drift = std::max(drift, std::max(made.overlap, made.radius) + rounding);
  }
  if (sizes.front().in_balls && reaches_few_cells(gas, *classes.front())) {
    balls.resize(gas.size());
    leave_balls();
  }
  bool have_one_width = true;
  for (Needle i{0}; i < gas.size(); ++i) {
    have_one_width = have_one_width && gas.body(i).width() == gas.body(Needle(0)).width();
  }
  if (!have_one_width) {
    half_widths.resize(gas.size());
    for (Needle i{0}; i < gas.size(); ++i) {
      half_widths[i] = static_cast<float>(gas.body(i).width() * per_length);
    }
  }
}

bool BoundingVolumes::place(Needle i, Time now, double half_length) {
  if (per_time == 0 || since_base(now) > longest_time) rebase(now, 1);
  return gas.falls ? place_one<true>(i, now, half_length) : place_one<false>(i, now, half_length);
}

// Without gravity, the compiler knows that there is none.
template <bool falls>
inline bool BoundingVolumes::place_one(Needle i, Time now, double half_length) {
  const Record& record = gas.records[i];
  const double elapsed = gas.clock.difference(now, record.time);
  const MotionFrom<FreeFlight> present{FreeFlight(record.flight, falls ? &gas.gravity : nullptr),
                                       elapsed};
  const FreeFlight& motion = present.motion;
  const Vec3d centre = present.centre();
  const Path path =
      falls ? path_of(centre, present.velocity(), now) : Path{centre, present.velocity()};
  ClassCells& own = class_of(i);
  Cell cell;
  Vec3d r, a;
  double stay;
  if (own.kind == BoundingVolume::cell) {
    cell = own.grid.cell_of(centre);
    stay = own.grid.time_to_leave(cell, present, own.overlap);
    r = path.centre;
    a = path.velocity * (per_length / per_time);
  } else {
    // The capsule is around where the needle will be in half of its time there, so that it may
    // move by the radius before that and after.
    const double speed =
        motion.fastest(elapsed, elapsed) + half_length * motion.fastest_rotation(elapsed, elapsed);
    double half = own.radius / speed;
    if (falls) {
      // The speed in the middle is greater by up to |g| half, and changes by as much from there on.
      const double pull = std::sqrt(dot(gas.gravity, gas.gravity));
      half = 2 * own.radius / (speed + std::sqrt(speed * speed + 6 * pull * own.radius));
    }
    stay = 2 * half;
    const double middle = std::isfinite(half) ? elapsed + half : elapsed;
    r = motion.centre(middle);
    a = motion.director(middle);
    cell = own.grid.cell_of(r);
  }
  const bool crosses = enter(own, i, cell);
  places[i].next_event = gas.clock.add(now, stay);
  motions[i].half = static_cast<float>(half_length * per_length);
  assert(fits_words(i, r));
  write_entry(own, i, r, a, now);
  set_motion(i, elapsed, path, now);
  return crosses;
}

bool BoundingVolumes::place_in_ball(Needle i, Time now, bool& is_new) {
  if (per_time == 0 || since_base(now) > longest_time) rebase(now, 1);
  const Record& record = gas.records[i];
  const double elapsed = gas.clock.difference(now, record.time);
  const Vec3d centre = kernels::centre_after(record.flight, elapsed), v = record.flight.v;
  ClassCells& own = class_of(i);
  Ball& ball = balls[i];
  if (const Shift& image = gas.images[i]; !same(ball.image, image)) follow_wraps(i, image, now);
  const double square = own.radius * own.radius;
  Vec3d from = centre - ball.centre;
  double room = square - dot(from, from);
  is_new = !(room > least_room * square);
  bool crosses = false;
  if (is_new) {
    ball.centre = centre;
    from = {};
    room = square;
    crosses = enter(own, i, own.grid.cell_of(centre));
    motions[i].half = 0;
    write_entry(own, i, centre, record.flight.u, now);
  }
  const double outwards = dot(from, v), vv = dot(v, v),
               root = std::sqrt(outwards * outwards + vv * room);
  const double stay = outwards > 0 ? room / (root + outwards) : (root - outwards) / vv;
  places[i].next_event =
      gas.clock.add(now, vv > 0 ? stay : std::numeric_limits<double>::infinity());
  set_motion(i, elapsed, {centre, v}, now);
  return crosses;
}

void BoundingVolumes::leave_balls() {
  const double nowhere = std::numeric_limits<double>::quiet_NaN();
  for (Ball& ball : balls) ball.centre = {nowhere, nowhere, nowhere};
}

// The record of a sphere has been wrapped: its ball and its cell are seen in its frame.
void BoundingVolumes::follow_wraps(Needle i, const Shift& image, Time now) {
  Ball& ball = balls[i];
  const Shift wraps = image - ball.image;
  ball.centre = ball.centre - gas.box_at(now).image(wraps).place;
  ball.image = image;
  places[i].cell = class_of(i).grid.image_of(places[i].cell, -wraps);
}

void BoundingVolumes::prepare(Time now, int threads) {
  // Early, so that there is always some time ahead.
  if (per_time == 0 || since_base(now) > 0.75 * longest_time) rebase(now, threads);
}

Time BoundingVolumes::prepared_until() const {
  return gas.clock.add(base, longest_time / per_time);
}

void BoundingVolumes::renumber(const std::vector<Needle>& ranks) {
  const std::vector<Needle> order = ranks_of(ranks);
  permute(places, order);
  permute(motions, order);
  if (!balls.empty()) permute(balls, order);
  if (!half_widths.empty()) permute(half_widths, order);
  for (const auto& each : classes) each->cells.renumber(ranks);
}

// Chooses the unit of time and the origin of times in blocks and motions.
void BoundingVolumes::begin_again(Time now) {
  double sum = 0;
  for (const Record& record : gas.records) {
    const Vec3d v = record.flight.v * per_length;
    sum += dot(v, v) + 0.25 * record.flight.omega * record.flight.omega;
  }
  const double speed = std::sqrt(sum / static_cast<double>(gas.size()));
  per_time = speed > 0 && std::isfinite(speed) ? times_power_of_two(1, exponent_of(speed)) : 1;
  base = now;
  longest_time = kernels::longest_time;
  if (gas.falls) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& each : classes) least = std::min(least, each->most_fallen);
    const double pull = std::sqrt(dot(gas.gravity, gas.gravity));
    longest_time = std::min(longest_time, std::sqrt(2 * least / pull) * per_time);
  }
}

// Does the same for needles that stay where they are, before times grow so long that floats lose
// digits of them.
void BoundingVolumes::rebase(Time now, int threads) {
  begin_again(now);
  kernels::in_parallel(gas.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (Needle i(begin); i < end; ++i) {
      if (!places[i].is_entered()) continue;
      const auto present = gas.motion_from(gas.records[i], now);
      const Path path = path_of(present.centre(), present.velocity(), now);
      set_motion(i, present.start, path, now);
      ClassCells& own = class_of(i);
      if (own.kind == BoundingVolume::capsule) continue;
      // The centre fits its words, except that of a needle that has just collided and was taken to
      // the other side of the box: it is placed again before any needle searches.
      write_entry(own, i, path.centre, path.velocity * (per_length / per_time), now);
    }
  });
}

// All but the half length, which does not depend on the units of time.
void BoundingVolumes::set_motion(Needle i, double elapsed, const Path& path, Time now) {
  const kernels::Flight& flight = gas.records[i].flight;
  const SineCosine<double> sc = sine_cosine(flight.omega * elapsed);
  const double unit_of_time = 1 / per_time;
  Motion& out = motions[i];
  const Vec3d corner = class_of(i).grid.corner(places[i].cell);
  store(out.r, (path.centre - corner) * per_length);
  store(out.v, path.velocity * (per_length * unit_of_time));
  store(out.u, flight.u * sc.cosine + flight.p * sc.sine);
  store(out.p, flight.p * sc.cosine - flight.u * sc.sine);
  out.omega = static_cast<float>(flight.omega * unit_of_time);
  out.time = static_cast<float>(since_base(now));
  out.until = rounded_up(places[i].next_event);
}

BoundingVolumes::Range BoundingVolumes::path_along(int axis, const kernels::Seeker& seeker,
                                                   float ahead) const {
  const auto pull =
      static_cast<float>(component(gas.gravity, axis) * per_length / (per_time * per_time));
  const float r = seeker.motion.r[axis] + 0.5f * pull * (seeker.now * seeker.now);
  const float v = seeker.motion.v[axis] + pull * seeker.now;
  const float end = (v + 0.5f * pull * ahead) * ahead;
  Range out{r + std::min(0.0f, end), r + std::max(0.0f, end)};
  // It turns back on the way.
  if (v * pull < 0 && std::abs(v) < std::abs(pull) * ahead) {
    const float turn = r - 0.5f * v * v / pull;
    out = {std::min(out.low, turn), std::max(out.high, turn)};
  }
  return out;
}

float BoundingVolumes::bend(float now, float ahead, const ClassCells& own) const {
  const double time = (now + ahead) / per_time;
  const double fallen = 0.5 * std::sqrt(dot(gas.gravity, gas.gravity)) * time * time;
  // Neither path leaves the cell that contains all bounding volumes of the class.
  const auto sides = grid.sides();
  const double widest = 2 * (sides[0] + sides[1] + sides[2] + 3 * drift) + own.most_fallen;
  return static_cast<float>(std::min(fallen, widest) * per_length);
}

// Whether words can hold a centre in the needle's cell.
bool BoundingVolumes::fits_words(Needle i, const Vec3d& centre) const {
  const ClassCells& own = class_of(i);
  const kernels::WordFormat& format = own.format;
  const Vec3d r = (centre - own.grid.corner(places[i].cell)) * per_length;
  return format.holds(r.x) && format.holds(r.y) && format.holds(r.z);
}

// Writes the needle's entry, with its velocity or director, into its slot.
void BoundingVolumes::write_entry(ClassCells& own, Needle i, const Vec3d& centre,
                                  const Vec3d& direction, Time now) {
  const Place& place = places[i];
  const bool velocities = own.kind == BoundingVolume::cell;
  NeedleBlock& block = own.cells[place.slot.block];
  const Vec3d r = (centre - own.grid.corner(place.cell)) * per_length;
  const double coordinate[3] = {r.x, r.y, r.z};
  const double component[3] = {direction.x, direction.y, direction.z};
  for (int axis = 0; axis < 3; ++axis) {
    block.word[axis][place.slot.lane] =
        velocities ? own.format.with_velocity(coordinate[axis], component[axis])
                   : own.format.with_director(coordinate[axis], component[axis]);
  }
  if (velocities) {
    block.time[place.slot.lane] = static_cast<float>(since_base(now));
  }
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
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t parts = all[axis] / common[axis];
    out[axis] = (out[axis] - (out[axis] < 0 ? parts - 1 : 0)) / parts;
  }
  return out;
}

}  // namespace needlework
