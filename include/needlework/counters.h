// Counters of the work done. No trajectory depends on them.
#pragma once

#include <array>
#include <cstdint>

namespace needlework {

struct Counters {
  std::uint64_t events = 0;         ///< all events taken from the calendar
  std::uint64_t stale = 0;          ///< contacts whose partner's record had been replaced
  std::uint64_t crossings = 0;      ///< changes of a needle's cell
  std::uint64_t rebuilds = 0;       ///< horizons without renewal: most leave a bounding volume
  std::uint64_t sorts = 0;          ///< spatial sorts of the storage
  std::uint64_t resized = 0;        ///< times that search and sizes were chosen again
  std::uint64_t renewals = 0;       ///< records renewed to keep their precision
  std::uint64_t searches = 0;       ///< searches over all candidates of a needle
  std::uint64_t candidates = 0;     ///< pairs that the search examined
  std::uint64_t filtered = 0;       ///< candidates decided by a filter alone
  std::uint64_t bracket_steps = 0;  ///< evaluations of the contact function in float with SIMD
  std::uint64_t predicted = 0;      ///< pairs whose first contact was computed
  std::uint64_t evaluated = 0;      ///< evaluations of the contact function in double
  std::uint64_t escalated = 0;      ///< evaluations of the contact function in double-double
  std::uint64_t touches = 0;        ///< touching third needles found when a record was replaced
  // For several threads; see docs/json.md.
  std::uint64_t phases = 0;    ///< stretches of time between two meetings of all threads
  std::uint64_t redone = 0;    ///< phases that one thread had to repeat
  std::uint64_t alone = 0;     ///< collisions that one thread processed while the others rested
  std::uint64_t border = 0;    ///< attempts of events that might read what another thread writes
  std::uint64_t deferred = 0;  ///< times that an event had to wait for others near it or a lock
  std::uint64_t waited = 0;    ///< times that a thread had no event that could proceed
  std::uint64_t messages = 0;  ///< to other threads, about changed events
  std::uint64_t stalls = 0;    ///< times that a thread was blocked
  std::uint64_t blocked = 0;   ///< total time that threads were blocked [ns]

  /// A counter and the key by which JSON, C and Python know it. Four keys are older than the names
  /// of their members, and stay for the scripts that use them.
  struct Named {
    const char* name;
    std::uint64_t Counters::*value;
  };
  static const std::array<Named, 24> all;

  Counters& operator+=(const Counters& other) {
    for (const Named& counter : all) this->*counter.value += other.*counter.value;
    return *this;
  }
};

inline constexpr std::array<Counters::Named, 24> Counters::all{{
    {"events", &Counters::events},
    {"stale", &Counters::stale},
    {"crossings", &Counters::crossings},
    {"rebuilds", &Counters::rebuilds},
    {"sorts", &Counters::sorts},
    {"resized", &Counters::resized},
    {"renewals", &Counters::renewals},
    {"searches", &Counters::searches},
    {"candidates", &Counters::candidates},
    {"filtered", &Counters::filtered},
    {"isolated", &Counters::bracket_steps},
    {"predicted", &Counters::predicted},
    {"evaluated", &Counters::evaluated},
    {"escalated", &Counters::escalated},
    {"touches", &Counters::touches},
    {"phases", &Counters::phases},
    {"redone", &Counters::redone},
    {"alone", &Counters::alone},
    {"border", &Counters::border},
    {"held", &Counters::deferred},
    {"waited", &Counters::waited},
    {"foreign", &Counters::messages},
    {"turns", &Counters::stalls},
    {"blocked", &Counters::blocked},
}};

}  // namespace needlework
