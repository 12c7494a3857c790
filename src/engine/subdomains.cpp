#include "src/engine/subdomains.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace needlework {
namespace {

std::size_t index_of(const CellCounts& cells, const CellCounts& at) {
  return (static_cast<std::size_t>(at[2]) * cells[1] + at[1]) * cells[0] + at[0];
}

// A box from `low` to just before `high`, to be divided into `subdomains` subdomains, the first of
// which is number `first`.
template <class Number>
struct Part {
  std::array<Number, 3> low, high;
  std::uint32_t first, subdomains;
};

// Cuts a part in two along its longest axis, and the parts again, until each belongs to one
// subdomain or cannot be cut further. length(part, axis) is the length of an axis, and cut(part,
// axis, share) the position where this share of the part ends.
template <class Number, class Length, class Cut, class Leaf>
void halve(const Part<Number>& whole, Length&& length, Cut&& cut, Leaf&& leaf) {
  std::vector<Part<Number>> parts = {whole};
  while (!parts.empty()) {
    const Part<Number> part = parts.back();
    parts.pop_back();
    // Among axes of equal length (to within rounding) the last is chosen, because cells that are
    // adjacent in memory then stay together.
    int axis = 0;
    for (int a = 1; a < 3; ++a) {
      if (length(part, a) >= length(part, axis) * (1 - 1e-9)) axis = a;
    }
    if (part.subdomains <= 1 || length(part, axis) == 0) {
      leaf(part);
      continue;
    }
    Part<Number> low = part, high = part;
    low.subdomains = part.subdomains / 2;
    high.first += low.subdomains;
    high.subdomains -= low.subdomains;
    low.high[axis] = high.low[axis] =
        cut(part, axis, static_cast<double>(low.subdomains) / part.subdomains);
    parts.push_back(low);
    parts.push_back(high);
  }
}

using CellPart = Part<std::int32_t>;

template <class Visit>
void for_each_cell(const CellPart& part, Visit&& visit) {
  CellCounts at;
  for (at[2] = part.low[2]; at[2] < part.high[2]; ++at[2]) {
    for (at[1] = part.low[1]; at[1] < part.high[1]; ++at[1]) {
      for (at[0] = part.low[0]; at[0] < part.high[0]; ++at[0]) visit(at);
    }
  }
}

}  // namespace

std::vector<std::uint32_t> divide_box(const CellCounts& cells, const std::array<double, 3>& box,
                                      const std::vector<std::size_t>& weight,
                                      std::uint32_t subdomains) {
  std::vector<std::uint32_t> out(weight.size(), 0);
  const auto length = [&](const CellPart& part, int axis) {
    const std::int32_t count = part.high[axis] - part.low[axis];
    return count < 2 ? 0 : count * box[axis] / cells[axis];
  };
  // Chooses the number of slices whose total weight is closest to the share.
  const auto cut = [&](const CellPart& part, int axis, double share) {
    std::vector<std::size_t> slices(part.high[axis] - part.low[axis]);
    std::size_t total = 0;
    for_each_cell(part, [&](const CellCounts& at) {
      slices[at[axis] - part.low[axis]] += weight[index_of(cells, at)];
      total += weight[index_of(cells, at)];
    });
    const double wanted = share * static_cast<double>(total);
    std::size_t count = 1;
    double below = static_cast<double>(slices[0]);
    while (count + 1 < slices.size() &&
           below + 0.5 * static_cast<double>(slices[count]) <= wanted) {
      below += static_cast<double>(slices[count++]);
    }
    return part.low[axis] + static_cast<std::int32_t>(count);
  };
  halve(CellPart{{0, 0, 0}, cells, 0, subdomains}, length, cut, [&](const CellPart& part) {
    for_each_cell(part, [&](const CellCounts& at) { out[index_of(cells, at)] = part.first; });
  });
  return out;
}

CellCounts multiples_to_divide(const std::array<double, 3>& box, std::uint32_t subdomains) {
  // Positions are fractions of the axes.
  using Share = Part<double>;
  std::array<std::vector<double>, 3> cuts;
  const auto length = [&](const Share& part, int axis) {
    return (part.high[axis] - part.low[axis]) * box[axis];
  };
  const auto cut = [&](const Share& part, int axis, double share) {
    cuts[axis].push_back(part.low[axis] + share * (part.high[axis] - part.low[axis]));
    return cuts[axis].back();
  };
  halve(Share{{0, 0, 0}, {1, 1, 1}, 0, subdomains}, length, cut, [](const Share&) {});
  CellCounts out = {1, 1, 1};
  // A larger multiple would be far from the cell count of any grid.
  const std::int32_t most = static_cast<std::int32_t>(std::min(2 * subdomains, 1000u));
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
                                      const std::vector<std::uint32_t>& subdomain,
                                      const std::array<std::int32_t, 3>& distance) {
  // The smallest and the largest subdomain number nearby, one axis after the other.
  std::vector<std::uint32_t> least = subdomain, greatest = subdomain;
  const CellPart all = {{0, 0, 0}, cells, 0, 1};
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
  std::vector<std::uint8_t> out(subdomain.size());
  for (std::size_t c = 0; c < subdomain.size(); ++c) out[c] = least[c] == greatest[c];
  return out;
}

}  // namespace needlework
