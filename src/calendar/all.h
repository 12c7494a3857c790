// The list of all calendars.
#pragma once

#include "src/calendar/bucket_calendar.h"
#include "src/calendar/calendar.h"
#include "src/calendar/cell_calendar.h"
#include "src/calendar/indexed_heap.h"
#include "src/calendar/lazy_heap.h"
#include "src/calendar/tournament.h"

namespace needlework {

/// A list of types, to be deduced from an argument. Does not compile with a type that is not a
/// calendar.
template <Calendar... Calendars>
struct CalendarList {};

/// The types of all calendars in a list such as CalendarList or testing::Types. Names, choices,
/// tests and benchmarks all follow from it.
template <template <class...> class List>
using AllCalendars = List<LazyHeap, IndexedHeap, Tournament, BucketCalendar, CellCalendar>;

}  // namespace needlework
