// What every event calendar offers: the next event of each needle, and the earliest of them all.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "src/calendar/event.h"

namespace needlework {

/// Which block of cells a needle is in, for calendars that group needles by place.
using BlockIndex = std::uint32_t;

/// Holds exactly one event for each of n needles, at first one that never happens.
///
/// `C(n, clock, blocks)` makes it for needles 0 to n - 1; `clock` is that of the events' times, and
/// needles are in blocks 0 to blocks - 1. Calendars that do not group needles ignore blocks, and
/// say so by `by_block`.
/// `set(event, block)` replaces the event of event.owner, who is in this block now; its time is
/// >= 0 and may lie before top().
/// `top()` is the least of all in the order of events; of equal ones, the two copies of one
/// contact, it is either. It exists unless empty(), which is to say n = 0. What `top()` and `of(i)`
/// refer to lasts until the next `set`.
/// `likely_next()` is a needle whose event may well be the one after top(), so that what it needs
/// can be prefetched: a guess, on which nothing else may depend. The calendar is not empty.
///
/// For the same events every calendar has the same top(), whatever it has held before. Nothing
/// throws but for lack of memory. One thread at a time.
template <class C>
concept Calendar = requires(C calendar, const C& view, const Event& event, Needle i, std::size_t n,
                            const Clock& clock, BlockIndex block) {
  { C::name } -> std::convertible_to<const char*>;
  { C::by_block } -> std::convertible_to<bool>;
  C(n, clock, n);
  { view.empty() } -> std::same_as<bool>;
  { view.top() } -> std::same_as<const Event&>;
  { view.of(i) } -> std::same_as<const Event&>;
  { view.likely_next() } -> std::same_as<Needle>;
  { calendar.set(event, block) } -> std::same_as<void>;
};

}  // namespace needlework
