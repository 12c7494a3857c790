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

}  // namespace

LinkedLists::LinkedLists(const Gas& gas, Counters& counters, const SearchSetup& setup)
    : gas_(gas), counters_(counters), margin_(margin_of(gas)), place_(gas.size()) {
  // Cells much emptier than one needle each would only cost memory and crossings.
  const double needles = std::max<double>(1, static_cast<double>(gas.size()));
  const double volume = gas.box.volume();
  const double side = setup.cell_side.value_or(std::cbrt(volume / (2 * needles)));
  grid_ = CellGrid(gas.box.edges(), std::max(gas.longest + 4 * margin_, side), gas.size());
  head_.assign(grid_.size(), no_needle);
}

Time LinkedLists::place(Needle i, Time now, double /*half_length*/) {
  const auto motion = gas_.motion_from(gas_.records[i], now);
  Place& place = place_[i];
  const Cell cell = grid_.cell_of(motion.centre());
  if (!place.linked || cell != place.cell) {
    if (place.linked) unlink(i);
    counters_.crossings += place.linked;
    place.cell = cell;
    link(i);
  }
  return gas_.clock.add(now, grid_.time_to_leave(cell, motion, margin_));
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
