// What threads share in a phase, from one meeting to the next.
#pragma once

#include <omp.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "src/calendar/cell_calendar.h"
#include "src/engine/cell_box.h"
#include "src/engine/claims.h"
#include "src/engine/done_log.h"
#include "src/engine/fronts.h"
#include "src/engine/mail.h"
#include "src/engine/run.h"
#include "src/engine/zones.h"
#include "src/search/search.h"

namespace needlework {

/// Who may be where, what has been done, and how far each thread is.
template <Search S>
struct Phase {
  using Block = CellCalendar::Block;

  /// `sight`: how far from its cell an event looks for earlier ones. [L]
  Phase(Run& its_run, S& its_search, CellCalendar& its_calendar, int its_threads, double sight);

  /// Divides the box into zones, by where needles are now.
  void divide();
  /// `fastest`: a guess at the speed of the fastest needle; `most`: collisions of a thread.
  void begin(double fastest, std::uint64_t most);

  CellBox cell_of(Block block) const { return {places[block], {}}; }

  Run& run;
  S& search;
  CellCalendar& calendar;
  const std::uint32_t threads;
  const CellCounts cells;
  const double sight_of_done;   ///< others may be at work where what has been done is farther [L]
  const CellCounts neighbours;  ///< what needles of a cell read is not farther than this
  const CellBall reach;         ///< where an event looks for earlier ones
  CellCounts apart;             ///< events farther than this never touch the same
  std::vector<CellCounts> places;   ///< of the blocks
  std::vector<std::uint8_t> inner;  ///< of a block: nobody else ever comes near
  std::vector<std::uint8_t> ours;   ///< of a block: all within reach are of its zone
  Claims claims;
  DoneLog done;
  Fronts fronts;
  Mail mail;
  alignas(128) std::atomic<bool> amiss = false;  ///< all that has been done is to be undone
  std::atomic<bool> too_many = false;            ///< collisions of a thread
  std::uint64_t most_collisions = 0;             ///< of a thread
  const int spins;                               ///< before a waiting thread yields
};

template <Search S>
Phase<S>::Phase(Run& its_run, S& its_search, CellCalendar& its_calendar, int its_threads,
                double sight)
    : run(its_run),
      search(its_search),
      calendar(its_calendar),
      threads(static_cast<std::uint32_t>(its_threads)),
      cells(search.grid().counts()),
      // Two needles that may meet before one of them is placed anew, with room for rounding.
      sight_of_done(1.01 + 2 * search.drift()),
      neighbours(cells_within(search.grid(), sight_of_done)),
      reach(search.grid(), sight),
      claims(cells, neighbours, threads),
      done(search.grid(), run.gas.box),
      fronts(threads, sight_of_done),
      mail(threads),
      // With a core for each, most waits are shorter than a visit to the system.
      spins(its_threads <= omp_get_num_procs() ? 1000 : 32) {
  const CellCounts moves = cells_within(search.grid(), search.drift() + search.radius());
  for (int axis = 0; axis < 3; ++axis) {
    apart[axis] = 3 * neighbours[axis] + 2 * moves[axis];
    if (cells[axis] >= Claims::most_cells) {
      throw InputError("engine.threads = " + std::to_string(threads) +
                       ": expected 1 for a box of " + std::to_string(cells[axis]) +
                       " cells along an edge");
    }
  }
  const auto x = static_cast<Block>(cells[0]), y = static_cast<Block>(cells[1]);
  for (Block b = 0; b < calendar.blocks(); ++b) {
    places.push_back({static_cast<std::int32_t>(b % x), static_cast<std::int32_t>(b / x % y),
                      static_cast<std::int32_t>(b / x / y)});
  }
}

template <Search S>
void Phase<S>::divide() {
  std::vector<std::size_t> weight(calendar.blocks());
  for (Block b = 0; b < calendar.blocks(); ++b) weight[b] = calendar.needles_in(b);
  const std::vector<std::uint32_t> zone = divide_box(cells, run.gas.box, weight, threads);
  calendar.divide(zone, threads);
  inner = inner_cells(cells, zone, apart);
  ours = inner_cells(cells, zone, reach.reach());
}

template <Search S>
void Phase<S>::begin(double fastest, std::uint64_t most) {
  done.clear();
  mail.begin();
  fronts.begin(fastest);
  amiss = too_many = false;
  most_collisions = most;
}

}  // namespace needlework
