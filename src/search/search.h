// The interface of every search for the needles that one needle might meet.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "needlework/counters.h"
#include "src/physics/gas.h"
#include "src/search/setup.h"

namespace needlework {

namespace search_detail {
/// Stands for what the event processor does with a candidate.
struct AnyVisit {
  double operator()(Needle, const Shift&, double, double) const { return 0; }
};
}  // namespace search_detail

/// A search proposes, for one needle, the pairs (needle, shift) that it might meet before a time.
/// It may propose too many, never too few.
///
///   place(i, now) -> Time
///     Enters needle i where it is now, and returns until when others find it there. To be called
///     again at that time, and whenever its record has changed, before the next find() of any
///     needle that might meet it.
///   renumber(ranks)
///     Needle i has become needle ranks[i]; where the needles have been placed stays.
///   find(i, just_hit, now, ahead, visit)
///     Calls visit(j, shift, from, to) -> ahead for each image of a needle, j with `shift` boxes
///     added to its centre, that i might meet within the time `ahead` and before j is placed again.
///     They meet between now + from and now + to or not at all. The visit returns how far ahead it
///     still makes sense to look, and find() continues with that. `just_hit` is the needle with
///     which i has collided right now, or no_needle.
///   name() -> const char*          as scenes name it
///   cells() -> std::size_t         number of cells by which a calendar may group needles
///   cell_index(i) -> std::uint32_t cell in which i has been placed, less than cells()
///   prefetch(i)                    asks for the memory that place(i) will read
///
/// Nothing throws but for lack of memory.
template <class S>
concept Search = requires(S search, const S& view, Needle i, Time now, double ahead,
                          const std::vector<Needle>& ranks, search_detail::AnyVisit visit) {
  { view.name() } -> std::same_as<const char*>;
  { search.place(i, now) } -> std::same_as<Time>;
  { search.renumber(ranks) } -> std::same_as<void>;
  { search.find(i, i, now, ahead, visit) } -> std::same_as<void>;
  { view.cells() } -> std::convertible_to<std::size_t>;
  { view.cell_index(i) } -> std::convertible_to<std::uint32_t>;
  { view.prefetch(i) } -> std::same_as<void>;
};

}  // namespace needlework
