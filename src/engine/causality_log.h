// A log of processed events. Each new event is checked against later ones that have already been
// processed near it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "src/calendar/event_table.h"
#include "src/engine/cell_box.h"
#include "src/memory/large_array.h"
#include "src/memory/prefetch.h"

namespace needlework {

/// One needle of a processed event: its position at the event, and its speed before.
struct LoggedEvent {
  TimeKey key;
  Vec3d r;       ///< not wrapped into the box [L]
  double speed;  ///< [L/time]
  bool alone;    ///< the event concerns no other needle
  Time time;     ///< the exact time, of which the key has 53 bits
};

/// The processed events, grouped by the cell in which they took place. Several threads may use it
/// at once, as long as none adds to cells that another reads or adds to.
class CausalityLog {
 public:
  /// `longest`: length of the longest needles. [L]
  CausalityLog(const CellGrid& grid, const Clock& clock, double longest = 1)
      : grid_(grid), clock_(clock), longest_(longest), latest_(grid.size()), cells_(grid.size()) {
    for (int axis = 0; axis < 3; ++axis) {
      // Positions below 2^k sides are off by 2^(k - 25) at most.
      rounding_ += 0x1p-23 * grid.sides()[axis] * grid.counts()[axis];
    }
  }

  /// Forgets everything. Needed only when time goes back: what a phase has left is earlier than all
  /// events of the next one, and does not count.
  void clear() {
    std::fill(latest_.begin(), latest_.end(), 0);
    for (Cell& cell : cells_) {
      cell.entries.clear();
      cell.forgotten = 0;
    }
  }
  std::size_t cell_of(const Vec3d& r) const { return grid_.index_of(grid_.cell_of(r)); }
  /// Prefetches the memory that add() will access.
  void prefetch(std::size_t cell) const {
    const auto* const memory = reinterpret_cast<const char*>(&cells_[cell]);
    needlework::prefetch(&latest_[cell]);
    needlework::prefetch(memory);
    needlework::prefetch(memory + 64);
  }
  /// Adds an event to the cell of its position. No event before `hindmost` is expected any more, so
  /// that earlier entries can be forgotten. If one comes nevertheless, all needles of forgotten
  /// entries may have been met.
  void add(const LoggedEvent& event, std::size_t its_cell, TimeKey hindmost) {
    latest_[its_cell] = std::max(latest_[its_cell], event.key);
    Cell& cell = cells_[its_cell];
    if (cell.entries.size() == cell.entries.capacity()) forget_before(hindmost, cell);
    cell.entries.emplace_back(event, grid_.in_sides(event.r));
  }

  /// Whether all events of the log have earlier keys; to check that it need not be cleared.
  bool is_before(TimeKey key) const {
    return std::all_of(latest_.begin(), latest_.end(),
                       [&](TimeKey latest) { return latest == 0 || latest < key; });
  }
  std::size_t entries() const {
    std::size_t out = 0;
    for (const Cell& cell : cells_) out += cell.entries.size();
    return out;
  }

  /// Distance [L] beyond which two needles cannot have met between `from` and `until`. The
  /// position of one is known at time `from`, that of the other at `until`; `speeds` is the sum of
  /// their speeds in between.
  /// `length` is that of the longest needles.
  static double reach(TimeKey from, TimeKey until, double speeds, double length = 1) {
    const double then = EventTable::time_of(until);
    const double time = then - EventTable::time_of(from) + 0x1p-50 * then;
    return length * (1 + 0x1p-20) + time * speeds * (1 + 0x1p-20);
  }

  /// Whether the needle of event `mine`, with `speed` since, may have met a needle whose later
  /// event has already been processed, before that later event. Looks no farther than `farthest`
  /// along each axis.
  bool may_have_met(const LoggedEvent& mine, double speed, double farthest) const {
    const Vec3d here = grid_.in_sides(mine.r);
    return any_in(cells_around(grid_, mine.r, farthest), grid_.counts(), [&](std::uint32_t index) {
      if (latest_[index] < mine.key) return false;
      const Cell& cell = cells_[index];
      if (mine.key <= cell.forgotten) return true;
      return std::any_of(cell.entries.begin(), cell.entries.end(), [&](const Entry& other) {
        if (other.time < mine.time) return false;
        // Each concerns one needle.
        if (other.time == mine.time && mine.alone && other.is_alone()) return false;
        const double distance =
            reach(mine.key, key_of(other), speed + other.speed(), longest_) + rounding_;
        return square_of_distance(other, here) < distance * distance;
      });
    });
  }

 private:
  // A logged event, rounded: the log competes with the gas for the cache.
  struct Entry {
    Time time;
    float at[3];  // as CellGrid::in_sides [side]
    // Sign: whether it is alone. The rest is the upper half of its speed, rounded up.
    std::uint32_t sign_and_speed;

    Entry(const LoggedEvent& event, const Vec3d& in_sides)
        : time(event.time),
          at{static_cast<float>(in_sides.x), static_cast<float>(in_sides.y),
             static_cast<float>(in_sides.z)},
          sign_and_speed(
              static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(event.speed) >> 32) + 1) {
      if (event.alone) sign_and_speed |= sign;
    }
    bool is_alone() const { return (sign_and_speed & sign) != 0; }
    double speed() const {
      return std::bit_cast<double>(std::uint64_t{sign_and_speed & ~sign} << 32);
    }

   private:
    static constexpr std::uint32_t sign = std::uint32_t{1} << 31;
  };
  static_assert(sizeof(Entry) == 32);
  struct alignas(128) Cell {
    boost::container::small_vector<Entry, 3> entries;
    TimeKey forgotten = 0;  ///< latest of those that are no longer among them
  };
  static_assert(sizeof(Cell) == 128);

  TimeKey key_of(const Entry& entry) const { return EventTable::key_of(entry.time, clock_); }
  void forget_before(TimeKey hindmost, Cell& cell) const {
    const auto before = [&](const Entry& entry) {
      const TimeKey key = key_of(entry);
      if (key >= hindmost) return false;
      cell.forgotten = std::max(cell.forgotten, key);
      return true;
    };
    cell.entries.erase(std::remove_if(cell.entries.begin(), cell.entries.end(), before),
                       cell.entries.end());
  }

  double square_of_distance(const Entry& a, const Vec3d& b) const {
    const Vec3d apart = grid_.shortest({a.at[0] - b.x, a.at[1] - b.y, a.at[2] - b.z});
    return dot(apart, apart);
  }

  CellGrid grid_;
  Clock clock_;
  double longest_;
  double rounding_ = 0;         ///< how far entries may be from where their events were [L]
  LargeArray<TimeKey> latest_;  ///< of all events of a cell; apart from them, so that a look
                                ///< around touches little memory
  LargeArray<Cell> cells_;
};

}  // namespace needlework
