#include "src/search/linked_lists.h"

#include <algorithm>
#include <cmath>

namespace needlework {
namespace {

// A needle stays in its cell until it is out of it by so much, which rounding of its centre in a
// wide box must not undo.
double margin_of(const Gas& gas) {
  return 0x1p-30 * gas.longest + 0x1p-48 * gas.box.longest_edge();
}

// Places of rows are brought into the box when one may have slid by so many edges.
constexpr double most_slid = 0x1p10;

}  // namespace

LinkedLists::LinkedLists(const Gas& gas, Counters& counters, const SearchSetup& setup)
    : gas_(gas), counters_(counters), margin_(margin_of(gas)), place_(gas.size()) {
  // Cells much emptier than one needle each would only cost memory and crossings.
  const double needles = std::max<double>(1, static_cast<double>(gas.size()));
  const double volume = gas.box.volume();
  const double side = setup.cell_side.value_or(std::cbrt(volume / (2 * needles)));
  grid_ = CellGrid(gas.box.edges(), std::max(gas.longest + 4 * margin_, side), gas.size());
  head_.assign(grid_.size(), no_needle);
  if (gas.shear) rows_.emplace(gas, grid_);
}

Time LinkedLists::place(Needle i, Time now, double /*half_length*/) {
  if (rows_) return place_in_row(i, now);
  return gas_.clock.add(now, enter(i, gas_.motion_from(gas_.records[i], now)));
}

// Returns for how long it stays.
double LinkedLists::enter(Needle i, const MotionFrom<FreeFlight>& motion) {
  Place& place = place_[i];
  const Cell cell = grid_.cell_of(motion.centre());
  if (!place.linked || cell != place.cell) {
    if (place.linked) unlink(i);
    counters_.crossings += place.linked;
    place.cell = cell;
    link(i);
  }
  return grid_.time_to_leave(cell, motion, margin_);
}

Time LinkedLists::place_in_row(Needle i, Time now) {
  const double slide = std::abs(rows_->slide()), slid = slide * grid_.counts()[1] * rows_->age(now);
  if (slid > most_slid * gas_.box.edge(0)) carry_rows(now);
  const Record& record = gas_.records[i];
  const double elapsed = gas_.clock.difference(now, record.time);
  const SlidingRows::Seen seen = SlidingRows::Present(*rows_, now).see(record, elapsed, 0);
  place_[i].wraps = seen.boxes;
  const FreeFlight flight(seen.flight, gas_.falls ? &gas_.gravity : nullptr);
  // In so long, the next row gets no farther than to the next cells but one.
  return gas_.clock.add(now, std::min(enter(i, {flight, elapsed}), 2 * grid_.sides()[0] / slide));
}

// Of needles that stay in their cells.
void LinkedLists::carry_rows(Time now) {
  const std::vector<std::int32_t> boxes = rows_->carry(now);
  for (Place& place : place_) {
    if (!place.linked) continue;
    const auto row = static_cast<std::size_t>(place.cell[1]);
    place.wraps = place.wraps + Shift{boxes[row], 0, 0};
  }
}

std::pair<std::int32_t, std::int32_t> LinkedLists::columns_near(
    const SearchQuery& query, const SlidingRows::Present& rows,
    const SlidingRows::Beside& beside) const {
  const Place& own = place_[query.needle];
  const Record& record = gas_.records[query.needle];
  const double elapsed = gas_.clock.difference(query.now, record.time);
  const kernels::Flight seen = rows.see_from(own.cell[1], own.wraps, record, elapsed);
  const double x = kernels::centre_after(seen, elapsed).x - beside.place,
               v = seen.v.x - beside.velocity, way = v == 0 ? 0 : v * query.ahead,
               reach = gas_.longest + 2 * margin_;
  const auto column = [&](double at) { return grid_.cell_of({at, 0, 0})[0]; };
  return {column(x + std::min(0.0, way) - reach), column(x + std::max(0.0, way) + reach)};
}

void LinkedLists::renumber(const std::vector<Needle>& ranks) {
  const auto renamed = [&](Needle i) { return i == no_needle ? i : ranks[i]; };
  for (Needle& head : head_) head = renamed(head);
  std::vector<Place> places(place_.size());
  for (std::size_t i = 0; i < place_.size(); ++i) {
    Place& place = places[ranks[i]] = place_[i];
    place.next = renamed(place.next);
    place.previous = renamed(place.previous);
  }
  place_ = std::move(places);
}

void LinkedLists::link(Needle i) {
  Place& place = place_[i];
  Needle& head = head_[grid_.index_of(place.cell)];
  place.linked = true;
  place.previous = no_needle;
  place.next = head;
  if (head != no_needle) place_[head].previous = i;
  head = i;
}

void LinkedLists::unlink(Needle i) {
  const Place& place = place_[i];
  if (place.previous != no_needle) {
    place_[place.previous].next = place.next;
  } else {
    head_[grid_.index_of(place.cell)] = place.next;
  }
  if (place.next != no_needle) place_[place.next].previous = place.previous;
}

}  // namespace needlework
