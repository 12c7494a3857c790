// Runs a scene with every search and on two threads, checks each collision, and audits the run.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "src/audit/audit.h"
#include "tests/support/by_build.h"
#include "tests/support/runs.h"

namespace needlework::test {

using Three = std::array<double, 3>;

/// Debug builds do a tenth of the work.
inline constexpr int thin = by_build(1, 10);

/// How a hard scene is checked.
struct Watch {
  bool everywhere = true;  ///< with every search and size; otherwise with a few of them
  double share = 1;        ///< fraction of pairs that are audited
  /// Number of flights of pairs whose result may depend on rounding, among those checked.
  std::uint64_t undecided = 0;
  bool by_rounding = false;  ///< rounding decides so much that levels of accuracy may give
                             ///< different ends
  /// The audit's collision rule squares energies, so it cannot be used for velocities near the
  /// ends of the range.
  bool audited = true;
};

/// The results of the run with all-pairs, which all other runs equal.
struct HardRun {
  std::vector<Collision> collisions;
  State initial, end;
  Totals first, last;
  Stop stop = Stop::interrupted;  ///< stays so if the run failed
  std::string failure;            ///< message of InvalidStateError
  double time = 0;
  std::string hash;
  Counters counters;
  audit::Findings findings;

  bool failed() const { return !failure.empty(); }
};

/// Runs from a state until an end. Expects of each collision: finite numbers, arms on the needles,
/// a time that neither decreases nor exceeds the end, energy that never grows. Expects of the
/// whole run: the energy that follows from the collisions, conserved momentum, all needles in the
/// box. Expects of the audit: nothing missed, wrong or late. Expects the same of every search, and
/// of two threads.
HardRun run_hard(const Scene& scene, const State& state, const Scene::Until& until,
                 const Watch& watch = {});
HardRun run_hard(const Scene& scene, const Scene::Until& until, const Watch& watch = {});

/// An empty state in a box, and needles added to it.
State empty_state(std::array<double, 3> box);
void add_needle(State& state, const std::array<double, 3>& r, const std::array<double, 3>& u,
                const std::array<double, 3>& v, const std::array<double, 3>& w);

}  // namespace needlework::test
