#include "src/engine/space_order.h"

#include <algorithm>
#include <array>

#include "src/machine/stop_request.h"
#include "src/search/box_cells.h"
#include "src/search/choice.h"

namespace needlework {
namespace {

// Spreads the lowest 21 bits so that two zero bits follow each.
std::uint64_t spread(std::uint64_t a) {
  a &= 0x1fffff;
  a = (a | a << 32) & 0x001f00000000ffff;
  a = (a | a << 16) & 0x001f0000ff0000ff;
  a = (a | a << 8) & 0x100f00f00f00f00f;
  a = (a | a << 4) & 0x10c30c30c30c30c3;
  return (a | a << 2) & 0x1249249249249249;
}

// A stable sort in pieces, between which it can be stopped.
void sort_by(const std::vector<std::uint64_t>& keys, std::vector<Needle>& order) {
  const auto before = [&](Needle a, Needle b) { return keys[a] < keys[b]; };
  const auto at = [&](std::size_t place) {
    return order.begin() + static_cast<std::ptrdiff_t>(std::min(place, order.size()));
  };
  constexpr std::size_t piece = std::size_t{1} << 19;
  for (std::size_t begin = 0; begin < order.size(); begin += piece) {
    StopRequest::check();
    std::stable_sort(at(begin), at(begin + piece), before);
  }
  for (std::size_t size = piece; size < order.size(); size *= 2) {
    for (std::size_t begin = 0; begin + size < order.size(); begin += 2 * size) {
      StopRequest::check();
      std::inplace_merge(at(begin), at(begin + size), at(begin + 2 * size), before);
    }
  }
}

}  // namespace

std::vector<Needle> order_in_space(const Gas& gas, Time now) {
  // One scale for all axes, in steps of about half a needle length.
  const double longest = gas.box.longest_edge();
  const double length = mean_length(gas.composition) * gas.longest;
  const double steps = std::min(2 * longest / length, 0x1p21 - 1);
  std::array<double, 3> cells;
  for (std::size_t axis = 0; axis < 3; ++axis) cells[axis] = gas.box.edge(axis) / longest * steps;
  std::size_t turn = 0;
  const std::vector<std::uint64_t> keys = keys_of_cells(gas, now, cells, [&](const BoxCell& cell) {
    StopRequest::check_in_turn(turn++);
    return spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2;
  });
  std::vector<Needle> order(gas.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = Needle(i);
  sort_by(keys, order);
  return order;
}

void reorder(Gas& gas, const std::vector<Needle>& order) {
  permute(gas.records, order);
  StopRequest::check();
  permute(gas.ids, order);
  permute(gas.images, order);
  if (gas.has_own_bodies()) permute(gas.own_bodies, order);
  gas.columns.permute(order);
}

}  // namespace needlework
