// Counters of the work done. Nothing in a trajectory depends on them.
#pragma once

#include <cstdint>

namespace needlework {

struct Counters {
  std::uint64_t events = 0;      ///< all that was popped
  std::uint64_t stale = 0;       ///< popped contacts whose partner had changed
  std::uint64_t crossings = 0;   ///< changes of cell
  std::uint64_t rebuilds = 0;    ///< hulls set anew because their needle left them
  std::uint64_t sorts = 0;       ///< of the storage, by place
  std::uint64_t resized = 0;     ///< times that search and sizes were chosen anew
  std::uint64_t renewals = 0;    ///< records renewed by their own clock
  std::uint64_t searches = 0;    ///< searches over all candidates of a needle
  std::uint64_t candidates = 0;  ///< pairs that the search looked at
  std::uint64_t filtered = 0;    ///< of these, settled by a filter
  std::uint64_t isolated = 0;    ///< evaluations by lanes of the contact function in float
  std::uint64_t predicted = 0;   ///< pairs whose first contact was computed
  std::uint64_t evaluated = 0;   ///< evaluations of the contact function in double
  std::uint64_t escalated = 0;   ///< evaluations of the contact function in double-double
  std::uint64_t touches = 0;     ///< third needles found touching where a record is made anew
  // Of several threads; see docs/how-it-works.md.
  std::uint64_t phases = 0;   ///< stretches of time between two meetings of all threads
  std::uint64_t redone = 0;   ///< of these, done again by one thread
  std::uint64_t border = 0;   ///< tries of events that might read what another thread writes
  std::uint64_t held = 0;     ///< times that an event had to wait for others near it
  std::uint64_t waited = 0;   ///< turns in which a thread had no event that it might do
  std::uint64_t foreign = 0;  ///< blocks of other threads written to
  std::uint64_t turns = 0;    ///< rows of events that a thread did until it was blocked
  std::uint64_t blocked = 0;  ///< time that threads were blocked, by all of them [ns]

  Counters& operator+=(const Counters& other) {
    for (const auto member : members) this->*member += other.*member;
    return *this;
  }

  static constexpr std::uint64_t Counters::*members[] = {
      &Counters::events,     &Counters::stale,     &Counters::crossings, &Counters::rebuilds,
      &Counters::sorts,      &Counters::resized,   &Counters::renewals,  &Counters::searches,
      &Counters::candidates, &Counters::filtered,  &Counters::isolated,  &Counters::predicted,
      &Counters::evaluated,  &Counters::escalated, &Counters::touches,   &Counters::phases,
      &Counters::redone,     &Counters::border,    &Counters::held,      &Counters::waited,
      &Counters::foreign,    &Counters::turns,     &Counters::blocked};
};

}  // namespace needlework
