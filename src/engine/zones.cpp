#include "src/engine/zones.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace needlework {
namespace {

std::size_t index_of(const CellCounts& cells, const CellCounts& at) {
  return (static_cast<std::size_t>(at[2]) * cells[1] + at[1]) * cells[0] + at[0];
}

// A box of cells from `low` to before `high`.
struct Part {
  CellCounts low, high;
  std::uint32_t first, zones;
};

template <class Visit>
void for_each_cell(const Part& part, Visit&& visit) {
  CellCounts at;
  for (at[2] = part.low[2]; at[2] < part.high[2]; ++at[2]) {
    for (at[1] = part.low[1]; at[1] < part.high[1]; ++at[1]) {
      for (at[0] = part.low[0]; at[0] < part.high[0]; ++at[0]) visit(at);
    }
  }
}

// Of axes equal but for rounding the last, so that cells next to each other in memory stay
// together.
template <class Length>
int longest(Length&& length) {
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    if (length(a) >= length(axis) * (1 - 1e-9)) axis = a;
  }
  return axis;
}

}  // namespace

std::vector<std::uint32_t> divide_box(const CellCounts& cells, const std::array<double, 3>& box,
                                      const std::vector<std::size_t>& weight, std::uint32_t zones) {
  std::vector<std::uint32_t> out(weight.size(), 0);
  std::vector<Part> parts = {{{0, 0, 0}, cells, 0, zones}};
  while (!parts.empty()) {
    const Part part = parts.back();
    parts.pop_back();
    const int axis = longest([&](int a) {
      const std::int32_t count = part.high[a] - part.low[a];
      return count < 2 ? 0 : count * box[a] / cells[a];
    });
    if (part.zones == 1 || part.high[axis] - part.low[axis] < 2) {
      for_each_cell(part, [&](const CellCounts& at) { out[index_of(cells, at)] = part.first; });
      continue;
    }
    std::vector<std::size_t> slices(part.high[axis] - part.low[axis]);
    std::size_t total = 0;
    for_each_cell(part, [&](const CellCounts& at) {
      slices[at[axis] - part.low[axis]] += weight[index_of(cells, at)];
      total += weight[index_of(cells, at)];
    });
    // The first slices whose weight is nearest to the share of half of the zones.
    const std::uint32_t half = part.zones / 2;
    const double share = static_cast<double>(total) * half / part.zones;
    std::size_t cut = 1;
    double below = static_cast<double>(slices[0]);
    while (cut + 1 < slices.size() && below + 0.5 * static_cast<double>(slices[cut]) <= share) {
      below += static_cast<double>(slices[cut++]);
    }
    Part low = part, high = part;
    low.high[axis] = high.low[axis] = part.low[axis] + static_cast<std::int32_t>(cut);
    low.zones = half;
    high.first += half;
    high.zones -= half;
    parts.push_back(low);
    parts.push_back(high);
  }
  return out;
}

CellCounts multiples_to_divide(const std::array<double, 3>& box, std::uint32_t zones) {
  // In parts of the axes.
  struct Part {
    std::array<double, 3> low, high;
    std::uint32_t zones;
  };
  std::array<std::vector<double>, 3> cuts;
  std::vector<Part> parts = {{{0, 0, 0}, {1, 1, 1}, zones}};
  while (!parts.empty()) {
    const Part part = parts.back();
    parts.pop_back();
    if (part.zones <= 1) continue;
    const int axis = longest([&](int a) { return (part.high[a] - part.low[a]) * box[a]; });
    const std::uint32_t half = part.zones / 2;
    const double share = static_cast<double>(half) / part.zones;
    const double cut = part.low[axis] + share * (part.high[axis] - part.low[axis]);
    cuts[axis].push_back(cut);
    Part low = part, high = part;
    low.high[axis] = high.low[axis] = cut;
    low.zones = half;
    high.zones -= half;
    parts.push_back(low);
    parts.push_back(high);
  }
  CellCounts out = {1, 1, 1};
  // More than that no grid is near to.
  const std::int32_t most = static_cast<std::int32_t>(std::min(2 * zones, 1000u));
  for (int axis = 0; axis < 3; ++axis) {
    const auto is_whole = [&](double cut) {
      return std::abs(cut * out[axis] - std::round(cut * out[axis])) < 1e-9;
    };
    while (!std::all_of(cuts[axis].begin(), cuts[axis].end(), is_whole)) {
      if (++out[axis] <= most) continue;
      out[axis] = 1;
      break;
    }
  }
  return out;
}

std::vector<std::uint8_t> inner_cells(const CellCounts& cells,
                                      const std::vector<std::uint32_t>& zone,
                                      const std::array<std::int32_t, 3>& distance) {
  // The least and the greatest zone around, one axis after the other.
  std::vector<std::uint32_t> least = zone, greatest = zone;
  const Part all = {{0, 0, 0}, cells, 0, 1};
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<std::uint32_t> least_before = least, greatest_before = greatest;
    const std::int32_t n = cells[axis], reach = std::min(distance[axis], n / 2);
    for_each_cell(all, [&](const CellCounts& at) {
      const std::size_t index = index_of(cells, at);
      for (std::int32_t d = -reach; d <= reach; ++d) {
        CellCounts other = at;
        other[axis] = (at[axis] + d + n) % n;
        const std::size_t near = index_of(cells, other);
        least[index] = std::min(least[index], least_before[near]);
        greatest[index] = std::max(greatest[index], greatest_before[near]);
      }
    });
  }
  std::vector<std::uint8_t> out(zone.size());
  for (std::size_t c = 0; c < zone.size(); ++c) out[c] = least[c] == greatest[c];
  return out;
}

}  // namespace needlework
