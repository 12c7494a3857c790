#include "src/search/ball_lists.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "src/physics/permutation.h"
#include "src/search/in_capsules.h"

namespace needlework {
namespace {

// A sphere in less room than this share of the square of its ball's radius gets another ball.
constexpr double least_room = 0x1p-10;

}  // namespace

bool BallLists::suit(const BoundingVolumes& volumes) {
  if (!volumes.sizes.front().in_balls) return false;
  const ClassCells& cells = *volumes.classes.front();
  const auto sides = cells.grid.sides();
  const double reach = volumes.gas.composition.widest() + 2 * cells.radius;
  return reach < NeighbourLists::farthest * std::min({sides[0], sides[1], sides[2]});
}

BallLists::BallLists(BoundingVolumes& volumes)
    : volumes_(volumes), balls_(volumes.gas.size()), lists_(volumes.gas.size()) {
  begin_again();
}

bool BallLists::place(Needle i, Time now, CellScan& scan) {
  BoundingVolumes& volumes = volumes_;
  const Gas& gas = volumes.gas;
  volumes.make_fit(now);
  const Record& record = gas.records[i];
  const double elapsed = gas.clock.difference(now, record.time);
  const Vec3d centre = kernels::centre_after(record.flight, elapsed), v = record.flight.v;
  ClassCells& own = volumes.class_of(i);
  Ball& ball = balls_[i];
  if (const Shift& image = gas.images[i]; !same(ball.image, image)) follow_wraps(i, image, now);
  const double square = own.radius * own.radius;
  Vec3d from = centre - ball.centre;
  double room = square - dot(from, from);
  const bool is_new = !(room > least_room * square);
  bool crosses = false;
  if (is_new) {
    ball.centre = centre;
    from = {};
    room = square;
    crosses = volumes.enter(own, i, own.grid.cell_of(centre));
    volumes.motions[i].half = 0;
    volumes.write_entry<InCapsules>(own, i, centre, record.flight.u, now);
  }
  const double outwards = dot(from, v), vv = dot(v, v),
               root = std::sqrt(outwards * outwards + vv * room);
  const double stay = outwards > 0 ? room / (root + outwards) : (root - outwards) / vv;
  volumes.places[i].next_event =
      gas.clock.add(now, vv > 0 ? stay : std::numeric_limits<double>::infinity());
  volumes.set_motion(i, elapsed, {centre, v}, now);
  if (is_new) list_neighbours(i, scan);
  for (const auto& each : lists_.of(i)) needlework::prefetch(&volumes.motions[each.needle]);
  return crosses;
}

void BallLists::begin_again() {
  const double nowhere = std::numeric_limits<double>::quiet_NaN();
  for (Ball& ball : balls_) ball.centre = {nowhere, nowhere, nowhere};
}

void BallLists::renumber(const std::vector<Needle>& ranks) {
  permute(balls_, ranks_of(ranks));
  lists_.renumber(ranks);
}

// The record of a sphere has been wrapped: its ball and its cell are seen in its frame.
void BallLists::follow_wraps(Needle i, const Shift& image, Time now) {
  Ball& ball = balls_[i];
  const Shift wraps = image - ball.image;
  ball.centre = ball.centre - volumes_.gas.box_at(now).image(wraps).place;
  ball.image = image;
  Cell& cell = volumes_.places[i].cell;
  cell = volumes_.class_of(i).grid.image_of(cell, -wraps);
}

void BallLists::list_neighbours(Needle i, CellScan& scan) {
  const std::size_t count = scan.look(i, 0).found;
  const kernels::Found found = scan.found();
  neighbours_.clear();
  const Cell& own = volumes_.places[i].cell;
  for (std::size_t k = 0; k < count; ++k) {
    const Cell& seen = scan.cell_seen(found.cell[k]);
    NeighbourLists::Neighbour each{Needle(found.needle[k]), {}};
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t cells = seen[axis] - own[axis];
      assert(std::abs(cells) <= NeighbourLists::farthest + 1);
      each.cells[axis] = static_cast<std::int8_t>(cells);
    }
    neighbours_.push_back(each);
  }
  lists_.replace(i, neighbours_);
}

kernels::Scan BallLists::look(Needle i, double ahead) {
  const ClassCells& own = volumes_.class_of(i);
  set_seeker(volumes_, own, i, ahead, seeker_);
  const std::array<double, 3> sides = own.grid.sides();
  for (int axis = 0; axis < 3; ++axis) {
    sides_[axis] = static_cast<float>(sides[axis] * volumes_.frame.per_length);
  }
  count_ = lists_.of(i).size();
  found_.make_room(count_);
  const kernels::Found found = found_.from(0);
  const NeighbourLists::ByFours list = lists_.by_fours(i);
  kernels::FourInts numbers{0, 1, 2, 3};
  for (std::size_t k = 0; k < count_; k += 4) {
    kernels::store_four(list(k).needles, found.needle + k);
    kernels::store_four(numbers, found.cell + k);
    numbers += 4;
  }
  return {count_, count_};
}

}  // namespace needlework
