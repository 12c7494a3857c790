#include "src/engine/make_loop.h"

#include <stdexcept>
#include <utility>

#include "src/calendar/any_calendar.h"
#include "src/calendar/cell_calendar.h"
#include "src/engine/loops/loops.h"

namespace needlework {
namespace {

template <Search S>
std::unique_ptr<Loop> with_search(Run& run, S search, LoopChoice& choice) {
  return make_event_loop(run, std::move(search), make_calendar(choice.calendar),
                         std::move(choice.replaced));
}

void require_one_thread(const LoopChoice& choice) {
  if (choice.threads == 1) return;
  throw std::logic_error("several threads cannot share the search " + choice.search +
                         " and the queue " + choice.calendar);
}

}  // namespace

std::unique_ptr<Loop> make_loop(Run& run, LoopChoice choice) {
  Counters& counters = run.tally.counters;
  if (const auto kind = NearSearch::kind_of(choice.search)) {
    choice.setup.keep_lists = choice.threads == 1;
    NearSearch search(run.gas, counters, choice.setup, *kind);
    if (choice.threads > 1 && choice.calendar == CellCalendar::name) {
      return make_parallel_loop(
          run, std::move(search), std::move(choice.replaced), choice.threads,
          ParallelTuning{.by_cost = !choice.all_threads, .place = choice.threads_place});
    }
    require_one_thread(choice);
    return with_search(run, std::move(search), choice);
  }
  require_one_thread(choice);
  if (choice.search == AllPairs::search_name)
    return with_search(run, AllPairs(run.gas, counters, choice.setup), choice);
  if (choice.search == LinkedLists::search_name)
    return with_search(run, LinkedLists(run.gas, counters, choice.setup), choice);
  throw std::logic_error("there is no search " + choice.search);
}

}  // namespace needlework
