// The interface of every event calendar: the next event of each needle, and the earliest of all.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "src/calendar/event.h"

namespace needlework {

/// Index of a cell of the search, in which a needle is. For calendars that group
/// needles by position.
using CellIndex = std::uint32_t;

/// Holds exactly one event for each of n needles, initially one that never happens.
///
/// `C(n, clock, cells)` makes a calendar for needles 0 to n - 1. `clock` is that of the events'
/// times, and needles are in cells 0 to cells - 1. Calendars that do not group needles ignore
/// cells, and have `by_cell` = false.
/// `set(event, cell)` replaces the event of event.owner, which is now in this cell. The time of
/// the event is >= 0 and may be earlier than top().
/// `of(i)` is the event of needle i. `top()` is the first of all events, in the order of
/// src/calendar/event.h. If both needles of a contact hold it, their two events are equal in that
/// order, and top() is either of them. It must not be called if empty(), which means n = 0.
/// References from `top()` and `of(i)` are valid until the next `set`.
/// `likely_next()` guesses the needle whose event follows top(), so that its data can be
/// prefetched. No result may depend on the guess. The calendar must not be empty.
/// `prefetch(i, cell)`, which a calendar need not have, prefetches what `set` of an event of
/// needle i in this cell will access.
///
/// For the same events every calendar has an equal top(), whatever it has held before. Nothing
/// throws except for lack of memory. Only one thread at a time may use a calendar by these
/// functions.
template <class C>
concept Calendar = requires(C calendar, const C& view, const Event& event, Needle i, std::size_t n,
                            const Clock& clock, CellIndex cell) {
  { C::name } -> std::convertible_to<const char*>;
  { C::by_cell } -> std::convertible_to<bool>;
  C(n, clock, n);
  { view.empty() } -> std::same_as<bool>;
  { view.top() } -> std::same_as<const Event&>;
  { view.of(i) } -> std::same_as<const Event&>;
  { view.likely_next() } -> std::same_as<Needle>;
  { calendar.set(event, cell) } -> std::same_as<void>;
};

}  // namespace needlework
