// Runs a scene by every search and on two threads, watches each collision, and has it audited.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "src/audit/audit.h"
#include "tests/support/runs.h"

namespace needlework::test {

/// How a hard scene is looked at.
struct Watch {
  bool everywhere = true;  ///< by every search and size; else by the best known few
  double share = 1;        ///< of pairs that are audited
  /// Flights of pairs that rounding may decide, of those checked.
  std::uint64_t undecided = 0;
  bool by_rounding = false;  ///< which decides so much that levels of accuracy may end otherwise
  /// The audit's collision rule squares the energies: not for velocities near the ends of range.
  bool audited = true;
};

/// What came of it: of the run by all-pairs, which all others equal.
struct HardRun {
  std::vector<Collision> collisions;
  State initial, end;
  Totals first, last;
  Stop stop = Stop::interrupted;  ///< that is left when it failed
  std::string failure;            ///< message of InvalidStateError
  double time = 0;
  std::string hash;
  Counters counters;
  audit::Tally tally;

  bool failed() const { return !failure.empty(); }
};

/// Runs from a state until an end. Expects of each collision: finite numbers, arms on the needles,
/// a clock that neither goes back nor leaps past the end, energy that never grows; of the whole:
/// the energy that the collisions say, the momentum kept, all needles in the box; of the audit:
/// nothing missed, wrong, late; of every search, and of two threads: the same.
HardRun run_hard(const Scene& scene, const State& state, const Scene::Until& until,
                 const Watch& watch = {});
HardRun run_hard(const Scene& scene, const Scene::Until& until, const Watch& watch = {});

/// An empty state in a box, and needles added to it.
State empty_state(std::array<double, 3> box);
void add_needle(State& state, const std::array<double, 3>& r, const std::array<double, 3>& u,
                const std::array<double, 3>& v, const std::array<double, 3>& w);

}  // namespace needlework::test
