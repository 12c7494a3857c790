// The data that threads share in a phase, from one meeting of all threads to the next.
#pragma once

#include <atomic>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "src/calendar/cell_calendar.h"
#include "src/engine/causality_log.h"
#include "src/engine/cell_box.h"
#include "src/engine/local_times.h"
#include "src/engine/mail.h"
#include "src/engine/region_locks.h"
#include "src/engine/run.h"
#include "src/engine/subdomains.h"
#include "src/machine/available_cores.h"
#include "src/search/search.h"

namespace needlework {

/// The data of a phase: subdomains, region locks, the log of processed events, and the progress of
/// each thread.
template <Search S>
struct Phase {
  /// `sight`: distance from its needles within which an event looks for earlier ones, in lengths
  /// of the longest needles. `place`: who asked for the threads, for messages.
  Phase(Run& its_run, S& its_search, CellCalendar& its_calendar, int its_threads, double sight,
        std::string_view place);

  /// Divides the box into subdomains by the present positions of the needles.
  void divide();
  /// Starts a new phase. `fastest` is an estimate of the largest speed of a needle, `most` the
  /// largest number of collisions of one thread.
  void begin(double fastest, std::uint64_t most);

  CellBox box_of(CellIndex cell) const { return {places[cell], {}}; }

  Run& run;
  S& search;
  CellCalendar& calendar;
  const std::uint32_t threads;
  const CellCounts cells;
  const double sight_of_log;    ///< no other thread writes to the log of processed events within
                                ///< this distance [L]
  const CellCounts neighbours;  ///< cells that cover this distance; an event reads nothing farther
                                ///< away
  const CellBall in_sight;      ///< where an event looks for earlier ones
  CellCounts independent;       ///< events farther apart never access the same data
  std::vector<CellCounts> places;   ///< of each cell in the grid
  std::vector<std::uint8_t> inner;  ///< for each cell: no other thread accesses data near it
  /// For each cell: the cells of other subdomains in sight, in rows from `first` to `end`
  /// - 1.
  struct Row {
    CellIndex first, end;
  };
  std::vector<Row> remote;
  std::vector<std::uint32_t> remote_from;  ///< where the rows of a cell begin in `remote`
  RegionLocks region_locks;
  CausalityLog causality_log;
  LocalTimes local_times;
  Mail mail;
  alignas(128) std::atomic<bool> must_roll_back = false;  ///< the phase must be rolled back
  std::atomic<bool> too_many = false;                     ///< a thread has had too many collisions
  std::atomic<bool> too_slow = false;                     ///< a thread has waited too long
  std::uint64_t most_collisions = 0;                      ///< of one thread
  bool may_be_too_slow = false;                           ///< whether long waits end the phase
  /// A thread that has waited for longer in a phase, and for most of the time, ends it. It is about
  /// a slice of the scheduler's time.
  static constexpr std::chrono::milliseconds longest_wait{4};
  const int spins;  ///< turns that a waiting thread spins before it
                    ///< yields
};

template <Search S>
Phase<S>::Phase(Run& its_run, S& its_search, CellCalendar& its_calendar, int its_threads,
                double sight, std::string_view place)
    : run(its_run),
      search(its_search),
      calendar(its_calendar),
      threads(static_cast<std::uint32_t>(its_threads)),
      cells(search.grid().counts()),
      // Needles closer than this may meet before one of them is placed again; includes rounding.
      sight_of_log(1.01 * run.gas.longest + 2 * search.drift()),
      neighbours(cells_within(search.grid(), sight_of_log)),
      in_sight(search.grid(), sight * run.gas.longest + search.drift()),
      region_locks(cells, neighbours, threads),
      causality_log(search.grid(), run.gas.clock, run.gas.longest),
      local_times(threads, sight_of_log, run.gas.longest),
      mail(threads),
      // If each thread has a core, most waits are shorter than a system call.
      spins(its_threads <= available_cores().usable() ? 1000 : 32) {
  // An event writes no farther than `neighbours` from the cell of its owner, as a partner and the
  // places of both may be, and reads no farther than that from where it writes.
  assert(search.radius() <= search.drift());
  for (int axis = 0; axis < 3; ++axis) {
    independent[axis] = 3 * neighbours[axis];
    if (cells[axis] >= RegionLocks::most_cells) {
      throw InputError(std::string(place) + ": expected 1 for a box of " +
                       std::to_string(cells[axis]) + " cells along an edge");
    }
  }
  const auto x = static_cast<CellIndex>(cells[0]), y = static_cast<CellIndex>(cells[1]);
  for (CellIndex c = 0; c < calendar.cells(); ++c) {
    places.push_back({static_cast<std::int32_t>(c % x), static_cast<std::int32_t>(c / x % y),
                      static_cast<std::int32_t>(c / x / y)});
  }
}

template <Search S>
void Phase<S>::divide() {
  const std::vector<std::uint32_t> subdomain =
      divide_box(cells, run.gas.box.edges(), calendar.needles_in_cells(), threads);
  // An event looks for earlier ones from its own cell, and from that of its partner.
  CellCounts far = in_sight.extent();
  for (int axis = 0; axis < 3; ++axis) far[axis] += neighbours[axis];
  std::vector<std::uint8_t> shown = inner_cells(cells, subdomain, far);
  for (std::uint8_t& each : shown) each = !each;
  calendar.divide(subdomain, threads, shown);
  inner = inner_cells(cells, subdomain, independent);
  const std::vector<std::uint8_t> ours = inner_cells(cells, subdomain, in_sight.extent());
  remote.clear();
  remote_from = {0};
  for (CellIndex c = 0; c < calendar.cells(); ++c) {
    if (!ours[c]) {
      in_sight.any_row(places[c], [&](CellIndex first, CellIndex end) {
        // Subdomains are boxes, so that two cells suffice.
        const bool own = subdomain[first] == subdomain[c] && subdomain[end - 1] == subdomain[c];
        if (!own) remote.push_back({first, end});
        return false;
      });
    }
    remote_from.push_back(static_cast<std::uint32_t>(remote.size()));
  }
}

template <Search S>
void Phase<S>::begin(double fastest, std::uint64_t most) {
  mail.begin();
  local_times.begin(fastest);
  must_roll_back = too_many = too_slow = false;
  most_collisions = most;
}

}  // namespace needlework
