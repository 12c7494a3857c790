// The list of all calendars.
#pragma once

#include "src/calendar/bucket_calendar.h"
#include "src/calendar/calendar.h"
#include "src/calendar/cell_calendar.h"
#include "src/calendar/indexed_heap.h"
#include "src/calendar/lazy_heap.h"
#include "src/calendar/tournament.h"

namespace needlework {

/// A list of types, to be deduced from an argument.
template <class... Calendars>
struct CalendarList {};

static_assert(Calendar<LazyHeap> && Calendar<IndexedHeap> && Calendar<Tournament> &&
              Calendar<BucketCalendar> && Calendar<CellCalendar>);

/// The types of all calendars in a list such as CalendarList or testing::Types.
template <template <class...> class List>
using AllCalendars = List<LazyHeap, IndexedHeap, Tournament, BucketCalendar, CellCalendar>;

}  // namespace needlework
