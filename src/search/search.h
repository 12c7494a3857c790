// The interface of every search for the needles that one needle might meet.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "needlework/counters.h"
#include "src/physics/gas.h"
#include "src/search/lengths.h"
#include "src/search/setup.h"

namespace needlework {

/// The needle with which one has collided right now, if any.
struct JustHit {
  Needle needle = no_needle;
  Shift shift{};     ///< of this image [boxes]
  double apart = 0;  ///< so long they do not meet again; 0 if not known [time]
};

/// Asks which needles one needle might meet.
struct SearchQuery {
  Needle needle;
  JustHit just_hit;
  Time now;
  double ahead;  ///< how far ahead to look [time]
};

namespace search_detail {
/// Stands for what the event processor does with a candidate.
struct AnyVisit {
  double operator()(Needle, const Shift&, double) const { return 0; }
};
}  // namespace search_detail

/// A search proposes, for one needle, the pairs (needle, shift) that it might meet before a time.
/// It may propose too many, never too few.
///
///   place(i, now, half_length) -> Time
///     Enters needle i where it is now, and returns until when others find it there. To be called
///     again at that time, and whenever its record has changed, before the next find() of any
///     needle that might meet it. `half_length` is half its length [L].
///   set_next_event(i, time)
///     Needle i will search again at this time, unless it is placed before. Until then, find() of
///     other needles may leave out what they meet of it after that time.
///   next_event(i) -> Time
///     That time or, if it is not set since place(), the one that place() returned; always
///     Time::never() for a search that does not keep it.
///   begin_again(now)
///     All records have been replaced now, and all needles will be placed before any find().
///   renumber(ranks)
///     Needle i has become needle ranks[i]; where the needles have been placed stays.
///   find(query, lengths, visit)
///     Calls visit(j, shift, from) -> ahead for each image of a needle, j with `shift` boxes added
///     to its centre, that query.needle might meet within the time query.ahead and before the
///     next event of j. They do not meet before now + from. The visit returns how far ahead it
///     still makes sense to look, and find() continues with that. The lengths are those with which
///     the needles have been placed.
///   name() -> const char*          as scenes name it
///   cells() -> std::size_t         number of cells by which a calendar may group needles
///   cell_index(i) -> std::uint32_t cell in which i has been placed, less than cells()
///   prefetch(i)                    asks for the memory that place(i) will read
///
/// Nothing throws but for lack of memory.
template <class S>
concept Search = requires(S search, const S& view, Needle i, Time now, const SearchQuery& query,
                          const std::vector<Needle>& ranks, const BodyLengths& lengths,
                          search_detail::AnyVisit visit) {
  { view.name() } -> std::same_as<const char*>;
  { search.place(i, now, lengths.half_length(i)) } -> std::same_as<Time>;
  { search.set_next_event(i, now) } -> std::same_as<void>;
  { view.next_event(i) } -> std::same_as<Time>;
  { search.begin_again(now) } -> std::same_as<void>;
  { search.renumber(ranks) } -> std::same_as<void>;
  { search.find(query, lengths, visit) } -> std::same_as<void>;
  { view.cells() } -> std::convertible_to<std::size_t>;
  { view.cell_index(i) } -> std::convertible_to<std::uint32_t>;
  { view.prefetch(i) } -> std::same_as<void>;
};

}  // namespace needlework
