// Runs members of a sweep side by side, one a thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/runs/failure.h"
#include "src/runs/sweep_folder.h"
#include "src/runs/sweep_grid.h"

namespace needlework::runs {

/// Estimates of the members' wall times, good for comparing them [s].
std::vector<double> estimated_costs(const sweep::Grid& grid);

/// Share `k` of `m` (from 0) of these members, the longest first. Each goes to the share that has
/// least so far, so that shares take about the same time; they depend on nothing else.
std::vector<std::size_t> share_of(std::span<const std::size_t> members,
                                  std::span<const double> costs, std::size_t k, std::size_t m);

/// What a member has cost in this process, which may have continued it.
struct MemberCost {
  std::uint64_t collisions = 0;  ///< computed here
  double wall_s = 0, cpu_s = 0;  ///< time of the event loop, the CPU time that of its thread
};

/// How a front end follows the members that run. Calls do not overlap, but for those of
/// stop_requested(), which several threads may call at once.
class SweepMonitor {
 public:
  virtual ~SweepMonitor() = default;

  /// Whether to show progress now, `elapsed` seconds of wall time into the sweep.
  virtual bool is_due(double elapsed) const = 0;
  /// `fraction` is the share of the work done, in [0, 1]; `finished` counts members.
  virtual void show(double elapsed, double fraction, std::size_t finished, std::size_t members) = 0;
  /// A member has been run to its end, and its file has its name.
  virtual void report_finished(const sweep::Member& /*member*/, const MemberCost& /*cost*/) {}
  /// A member could not be run; the others are continued.
  virtual void report_failure(const sweep::Member& member, const Failure& failure) = 0;
  /// Whether to end all members; asked several times a second.
  virtual bool stop_requested() const { return false; }
};

struct MemberRuns {
  const sweep::Grid& grid;
  const SweepFolder& folder;
  std::span<const std::size_t> members;  ///< to run, in this order
  std::span<const double> costs;         ///< of all members of the grid
  int threads = 1;                       ///< members at a time
};

/// Runs them; a member that fails concerns no other. A stop that the monitor requests ends all of
/// them within a fraction of a second. Puts the exit code of each into `exit_codes`, which has one
/// for each member of the grid: `stopped` also for those that another process is running.
void run_members(const MemberRuns& runs, SweepMonitor& monitor, std::span<int> exit_codes);

/// Memory of the largest members side by side [bytes].
double estimated_memory(const MemberRuns& runs);

}  // namespace needlework::runs
