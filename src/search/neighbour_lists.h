// Who is near whom, among bodies that stay in their bounding volumes through collisions.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "kernels/four.h"
#include "src/memory/large_array.h"
#include "src/memory/prefetch.h"
#include "src/physics/ids.h"

namespace needlework {

/// For each body, those whose bounding volumes overlap its own. It is in the lists of all that are
/// in its list.
class NeighbourLists {
 public:
  struct Neighbour {
    Needle needle;
    /// The cell in which it is seen, from the body's own: cells change with bounding volumes only.
    std::array<std::int8_t, 4> cells;
  };

  /// Four neighbours, in columns.
  struct FourNeighbours {
    kernels::FourInts needles, cells;

    /// By how many cells along this axis each is seen from the body's own cell.
    kernels::Four cells_along(int axis) const {
      const int byte = std::endian::native == std::endian::little ? axis : 3 - axis;
      return __builtin_convertvector((cells << (24 - 8 * byte)) >> 24, kernels::Four);
    }
  };
  /// The neighbours of a body by fours: those from number k on, of which any after the last one do
  /// not count.
  struct ByFours {
    const Neighbour* row;

    FourNeighbours operator()(std::size_t k) const {
      static_assert(sizeof(Neighbour) == 8 && offsetof(Neighbour, cells) == 4);
      kernels::FourInts low, high;
      std::memcpy(&low, row + k, sizeof low);
      std::memcpy(&high, row + k + 2, sizeof high);
      return {__builtin_shufflevector(low, high, 0, 2, 4, 6),
              __builtin_shufflevector(low, high, 1, 3, 5, 7)};
    }
  };

  static constexpr int farthest = 120;  ///< cells between two neighbours

  explicit NeighbourLists(std::size_t bodies) : counts_(bodies), rows_(bodies * room_) {}

  /// Asks for the memory of that.
  void prefetch(Needle i) const {
    needlework::prefetch(&counts_[i]);
    needlework::prefetch(row(i));
    needlework::prefetch(row(i) + 8);
  }
  std::span<const Neighbour> of(Needle i) const { return {row(i), counts_[i]}; }
  ByFours by_fours(Needle i) const { return {row(i)}; }
  /// Body i has got a bounding volume that overlaps those of these.
  void replace(Needle i, std::span<const Neighbour> neighbours);
  /// Empties all lists.
  void clear();
  void renumber(const std::vector<Needle>& ranks);

 private:
  Neighbour* row(Needle i) { return rows_.data() + i.index * room_; }
  const Neighbour* row(Needle i) const { return rows_.data() + i.index * room_; }
  void add(Needle i, const Neighbour& neighbour);
  void remove(Needle i, Needle neighbour);
  void make_room(std::size_t needed);

  std::size_t room_ = 24;  ///< in each row, in whole fours
  std::vector<std::uint32_t> counts_;
  LargeArray<Neighbour> rows_;
};

}  // namespace needlework
