// A log of the events processed since the threads last met. Each new event is checked against
// later ones that have already been processed near it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "src/calendar/event_table.h"
#include "src/engine/cell_box.h"
#include "src/memory/prefetch.h"

namespace needlework {

/// One needle of a processed event: its position at the event, and its speed before.
struct LoggedEvent {
  TimeKey key;
  Vec3d r;                 ///< not wrapped into the box [L]
  double speed;            ///< [L/time]
  Id lower_id, higher_id;  ///< of the event's two needles, or twice that of one alone
  Time time;               ///< the exact time, of which the key has 53 bits

  bool has_partner() const { return lower_id != higher_id; }
};
static_assert(sizeof(LoggedEvent) == 64);

/// The processed events, grouped by the cell in which they took place. Several threads may use it
/// at once, as long as none adds to cells that another reads or adds to.
class CausalityLog {
 public:
  /// `longest`: length of the longest needles. [L]
  CausalityLog(const CellGrid& grid, const std::array<double, 3>& box, double longest = 1)
      : grid_(grid), box_(box), longest_(longest), cells_(grid.size()) {}

  void clear() {
    for (Cell& cell : cells_) cell.clear();
  }
  std::size_t cell_of(const Vec3d& r) const { return grid_.index_of(grid_.cell_of(r)); }
  /// Prefetches the memory that add() will access.
  void prefetch(std::size_t cell) const { needlework::prefetch(&cells_[cell]); }
  /// Adds an event to the cell of its position. No event before `hindmost` is expected any more, so
  /// that earlier entries can be forgotten. If one comes nevertheless, all needles of forgotten
  /// entries may have been met.
  void add(const LoggedEvent& event, std::size_t its_cell, TimeKey hindmost) {
    Cell& cell = cells_[its_cell];
    if (cell.events.size() == cell.events.capacity()) cell.forget_before(hindmost);
    cell.events.push_back(event);
    cell.latest = std::max(cell.latest, event.key);
  }

  std::size_t entries() const {
    std::size_t out = 0;
    for (const Cell& cell : cells_) out += cell.events.size();
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
    return any_in(cells_around(grid_, mine.r, farthest), grid_.counts(), [&](std::uint32_t index) {
      const Cell& cell = cells_[index];
      if (cell.latest < mine.key) return false;
      if (mine.key <= cell.forgotten) return true;
      return std::any_of(cell.events.begin(), cell.events.end(), [&](const LoggedEvent& other) {
        return comes_after(other, mine) &&
               are_nearer(other.r, mine.r,
                          reach(mine.key, other.key, speed + other.speed, longest_));
      });
    });
  }

 private:
  struct Cell {
    std::vector<LoggedEvent> events;
    TimeKey latest = 0;     ///< of all events of the phase
    TimeKey forgotten = 0;  ///< latest of those that are no longer among them

    void clear() {
      events.clear();
      latest = forgotten = 0;
    }
    void forget_before(TimeKey hindmost) {
      std::erase_if(events, [&](const LoggedEvent& event) {
        if (event.key >= hindmost) return false;
        forgotten = std::max(forgotten, event.key);
        return true;
      });
    }
  };

  static bool comes_after(const LoggedEvent& a, const LoggedEvent& b) {
    if (a.time != b.time) return a.time > b.time;
    // The order of two searches at the same time does not matter.
    const auto order = [](const LoggedEvent& event) {
      return std::tuple(event.has_partner(), event.lower_id, event.higher_id);
    };
    return (a.has_partner() || b.has_partner()) && order(a) > order(b);
  }
  bool are_nearer(const Vec3d& a, const Vec3d& b, double distance) const {
    double squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double gap = (&a.x)[axis] - (&b.x)[axis];
      const double nearest = gap - std::nearbyint(gap / box_[axis]) * box_[axis];
      squares += nearest * nearest;
    }
    return squares < distance * distance;
  }

  CellGrid grid_;
  std::array<double, 3> box_;
  double longest_;
  std::vector<Cell> cells_;
};

}  // namespace needlework
