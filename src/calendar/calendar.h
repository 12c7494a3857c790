// What every event calendar offers: the next event of each needle, and the earliest of them all.
#pragma once

#include <concepts>
#include <cstddef>

#include "src/calendar/event.h"

namespace needlework {

/// Holds exactly one event for each of n needles, at first one that never happens.
///
/// `C(n, clock)` makes it for needles 0 to n - 1; `clock` is that of the events' times.
/// `set(event)` replaces the event of event.owner, whose time is >= 0 and may lie before top().
/// `top()` is the least of all in the order of events; of equal ones, the two copies of one
/// contact, it is either. It exists unless empty(), which is to say n = 0. What `top()` and `of(i)`
/// refer to lasts until the next `set`.
///
/// For the same events every calendar has the same top(), whatever it has held before. Nothing
/// throws but for lack of memory. One thread at a time.
template <class C>
concept Calendar = requires(C calendar, const C& view, const Event& event, Needle i, std::size_t n,
                            const Clock& clock) {
  { C::name } -> std::convertible_to<const char*>;
  C(n, clock);
  { view.empty() } -> std::same_as<bool>;
  { view.top() } -> std::same_as<const Event&>;
  { view.of(i) } -> std::same_as<const Event&>;
  { calendar.set(event) } -> std::same_as<void>;
};

}  // namespace needlework
