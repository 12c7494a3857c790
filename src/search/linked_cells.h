// Linked cells: the box is cut into cells of side >= L, so that needles in contact are in the same
// or in neighbouring cells. The classical search, and the one of the paper; slow when dense, since
// a cell cannot be smaller than a needle.
#pragma once

#include <array>
#include <vector>

#include "src/physics/gas.h"

namespace needlework {

class LinkedCells {
 public:
  static constexpr const char* name = "linked-cells";

  /// `gas` must outlive the search; needles are entered by insert().
  explicit LinkedCells(const Gas& gas);

  /// Enters needle i where it is at `now`; called once for each.
  void insert(Needle i, Time now);

  /// When i leaves its cell. Remembers when, and through which side.
  Time complete_until(Needle i, Time now);
  /// Moves i into the next cell if that time has come; says whether.
  bool move_on(Needle i, Time now);
  void rewrap(Needle i, const Shift& wraps);

  template <class Visit>
  void for_each_candidate(Needle i, Time, Time, Visit&& visit) const {
    const auto [cx, cy, cz] = place_[i].cell;
    for (std::int32_t z = cz - 1; z <= cz + 1; ++z) {
      const std::int32_t wz = wrap(z, 2);
      for (std::int32_t y = cy - 1; y <= cy + 1; ++y) {
        const std::int32_t wy = wrap(y, 1);
        for (std::int32_t x = cx - 1; x <= cx + 1; ++x) {
          const std::int32_t wx = wrap(x, 0);
          for (Needle j = head_[index(wx, wy, wz)]; j != no_needle; j = place_[j].next) {
            if (j == i) continue;  // an image of i itself is at least two needle lengths away
            const auto& c = place_[j].cell;
            visit(j, Shift{(x - c[0]) / count_[0], (y - c[1]) / count_[1], (z - c[2]) / count_[2]});
          }
        }
      }
    }
  }

  std::array<std::int32_t, 3> counts() const { return count_; }

 private:
  struct Place {
    std::array<std::int32_t, 3> cell{};  ///< unwrapped, in the frame of the needle's record
    Time exit = Time::never();
    std::int8_t exit_axis = 0;
    std::int8_t exit_step = 0;
    Needle next = no_needle, previous = no_needle;
  };

  std::int32_t wrap(std::int32_t c, int axis) const {
    const std::int32_t n = count_[axis];
    const std::int32_t m = c % n;
    return m < 0 ? m + n : m;
  }
  std::size_t index(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (static_cast<std::size_t>(z) * count_[1] + y) * count_[0] + x;
  }
  std::size_t index_of(const Place& place) const {
    return index(wrap(place.cell[0], 0), wrap(place.cell[1], 1), wrap(place.cell[2], 2));
  }
  void link(Needle i);
  void unlink(Needle i);

  const Gas& gas_;
  std::array<std::int32_t, 3> count_{};
  std::array<double, 3> side_{};
  std::vector<Needle> head_;
  std::vector<Place> place_;
};

}  // namespace needlework
