#include "src/search/linked_cells.h"

#include <algorithm>
#include <cmath>

namespace needlework {

LinkedCells::LinkedCells(const Gas& gas) : gas_(gas), place_(gas.size()) {
  // Needles may be a little outside of their cells by rounding; the sides carry the margin. Cells
  // much emptier than one needle each would only cost memory and crossings.
  constexpr double least_side = 1 + 0x1p-30;
  const double needles = std::max<double>(1, static_cast<double>(gas.size()));
  const double side =
      std::max(least_side, std::cbrt(gas.box[0] * gas.box[1] * gas.box[2] / (2 * needles)));
  std::size_t cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double fitting = std::floor(gas.box[axis] / side);
    count_[axis] = std::max<std::int32_t>(2, static_cast<std::int32_t>(fitting));
    side_[axis] = gas.box[axis] / count_[axis];
    cells *= count_[axis];
  }
  head_.assign(cells, no_needle);
}

void LinkedCells::insert(Needle i, Time now) {
  const Record& record = gas_.records[i];
  const Vec3d r = centre_after(record.flight, gas_.clock.difference(now, record.time));
  place_[i].cell = {static_cast<std::int32_t>(std::floor(r.x / side_[0])),
                    static_cast<std::int32_t>(std::floor(r.y / side_[1])),
                    static_cast<std::int32_t>(std::floor(r.z / side_[2]))};
  link(i);
}

Time LinkedCells::complete_until(Needle i, Time now) {
  const Record& record = gas_.records[i];
  const Vec3d r = centre_after(record.flight, gas_.clock.difference(now, record.time));
  const double position[3] = {r.x, r.y, r.z};
  const double velocity[3] = {record.flight.v.x, record.flight.v.y, record.flight.v.z};
  Place& place = place_[i];
  double first = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double v = velocity[axis];
    if (v == 0) continue;
    const double border = (place.cell[axis] + (v > 0 ? 1 : 0)) * side_[axis];
    const double dt = std::max(0.0, (border - position[axis]) / v);
    if (dt < first) {
      first = dt;
      place.exit_axis = static_cast<std::int8_t>(axis);
      place.exit_step = v > 0 ? 1 : -1;
    }
  }
  place.exit = gas_.clock.add(now, first);
  return place.exit;
}

bool LinkedCells::move_on(Needle i, Time now) {
  Place& place = place_[i];
  if (place.exit > now) return false;
  unlink(i);
  place.cell[place.exit_axis] += place.exit_step;
  link(i);
  return true;
}

void LinkedCells::rewrap(Needle i, const Shift& wraps) {
  for (int axis = 0; axis < 3; ++axis) place_[i].cell[axis] -= wraps[axis] * count_[axis];
}

void LinkedCells::link(Needle i) {
  Place& place = place_[i];
  Needle& head = head_[index_of(place)];
  place.previous = no_needle;
  place.next = head;
  if (head != no_needle) place_[head].previous = i;
  head = i;
}

void LinkedCells::unlink(Needle i) {
  const Place& place = place_[i];
  if (place.previous != no_needle) {
    place_[place.previous].next = place.next;
  } else {
    head_[index_of(place)] = place.next;
  }
  if (place.next != no_needle) place_[place.next].previous = place.previous;
}

}  // namespace needlework
