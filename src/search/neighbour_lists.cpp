#include "src/search/neighbour_lists.h"

#include <algorithm>

#include "src/physics/permutation.h"

namespace needlework {

void NeighbourLists::replace(Needle i, std::span<const Neighbour> neighbours) {
  // Nearly the same as the old ones.
  for (const Neighbour& each : neighbours) prefetch(each.needle);
  for (const Neighbour& old : of(i)) remove(old.needle, i);
  if (neighbours.size() > room_) make_room(neighbours.size());
  counts_[i] = static_cast<std::uint32_t>(neighbours.size());
  std::copy(neighbours.begin(), neighbours.end(), row(i));
  for (const auto& [needle, cells] : neighbours) {
    add(needle, {i,
                 {static_cast<std::int8_t>(-cells[0]), static_cast<std::int8_t>(-cells[1]),
                  static_cast<std::int8_t>(-cells[2])}});
  }
}

void NeighbourLists::clear() { std::fill(counts_.begin(), counts_.end(), 0); }

void NeighbourLists::renumber(const std::vector<Needle>& ranks) {
  permute(counts_, ranks_of(ranks));
  LargeArray<Neighbour> rows(rows_.size());
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    Neighbour* to = rows.data() + ranks[i].index * room_;
    for (std::size_t k = 0; k < counts_[ranks[i]]; ++k) {
      to[k] = row(Needle(i))[k];
      to[k].needle = ranks[to[k].needle];
    }
  }
  rows_.swap(rows);
}

void NeighbourLists::add(Needle i, const Neighbour& neighbour) {
  if (counts_[i] == room_) make_room(room_ + 1);
  row(i)[counts_[i]++] = neighbour;
}

// Of two images of one neighbour either may go, as the other one goes next.
void NeighbourLists::remove(Needle i, Needle neighbour) {
  Neighbour* const begin = row(i);
  Neighbour* const last = begin + counts_[i] - 1;
  for (Neighbour* each = begin; each <= last; ++each) {
    if (each->needle != neighbour) continue;
    *each = *last;
    --counts_[i];
    return;
  }
}

void NeighbourLists::make_room(std::size_t needed) {
  const std::size_t room = (std::max(needed, room_ + room_ / 2) + 3) / 4 * 4;
  LargeArray<Neighbour> rows(counts_.size() * room);
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    std::copy_n(row(Needle(i)), counts_[i], rows.data() + i * room);
  }
  rows_.swap(rows);
  room_ = room;
}

}  // namespace needlework
