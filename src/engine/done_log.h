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
struct Done {
  TimeKey key;
  Vec3d r;       ///< not wrapped into the box [L]
  double speed;  ///< [L/time]
  bool has_partner;
  Id lower_id, higher_id;  ///< of the event's two needles
  Time time;               ///< the exact time, of which the key has 53 bits
};

/// The processed events, grouped by the cell in which they took place. Several threads may use it
/// at once, as long as none adds to cells that another reads or adds to.
class DoneLog {
 public:
  /// `longest`: length of the longest needles. [L]
  DoneLog(const CellGrid& grid, const std::array<double, 3>& box, double longest = 1)
      : grid_(grid), box_(box), longest_(longest), done_(grid.size()), latest_(grid.size()) {}

  void clear() {
    std::fill(latest_.begin(), latest_.end(), TimeKey{0});
    for (std::vector<Done>& events : done_) events.clear();
  }
  /// Prefetches the memory that add() will access.
  void prefetch(const Vec3d& r) const {
    const std::size_t cell = grid_.index_of(grid_.cell_of(r));
    needlework::prefetch(&done_[cell]);
    needlework::prefetch(&latest_[cell]);
  }
  void add(const Done& done) {
    const std::size_t cell = grid_.index_of(grid_.cell_of(done.r));
    done_[cell].push_back(done);
    latest_[cell] = std::max(latest_[cell], done.key);
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
  bool may_have_met(const Done& mine, double speed, double farthest) const {
    return any_in(cells_around(grid_, mine.r, farthest), grid_.counts(), [&](std::uint32_t cell) {
      if (latest_[cell] < mine.key) return false;
      return std::any_of(done_[cell].begin(), done_[cell].end(), [&](const Done& other) {
        return comes_after(other, mine) &&
               are_nearer(other.r, mine.r,
                          reach(mine.key, other.key, speed + other.speed, longest_));
      });
    });
  }

 private:
  static bool comes_after(const Done& a, const Done& b) {
    if (a.time != b.time) return a.time > b.time;
    // The order of two searches at the same time does not matter.
    return (a.has_partner || b.has_partner) && std::tie(a.has_partner, a.lower_id, a.higher_id) >
                                                   std::tie(b.has_partner, b.lower_id, b.higher_id);
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
  std::vector<std::vector<Done>> done_;  ///< by cell
  std::vector<TimeKey> latest_;          ///< latest key in each cell
};

}  // namespace needlework
