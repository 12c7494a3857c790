// All event loops that are compiled. Those of one search are in one file; those of several threads
// have a file of their own.
#pragma once

#include <memory>

#include "src/calendar/any_calendar.h"
#include "src/engine/loop.h"
#include "src/engine/parallel_tuning.h"
#include "src/engine/replaced_records.h"
#include "src/search/all_pairs.h"
#include "src/search/linked_lists.h"
#include "src/search/near_search.h"
#include "src/search/search.h"

namespace needlework {

/// The single-threaded loop with this search, for the effects `run.effects`.
template <Search S>
std::unique_ptr<Loop> make_event_loop(Run& run, S search, std::unique_ptr<AnyCalendar> calendar,
                                      ReplacedRecords replaced);

/// The multi-threaded loop, for the effects `run.effects`.
std::unique_ptr<Loop> make_parallel_loop(Run& run, NearSearch search, ReplacedRecords replaced,
                                         int threads, const ParallelTuning& tuning);

}  // namespace needlework
