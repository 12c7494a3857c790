// Runs members of a sweep side by side, one a thread.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/runs/sweep_folder.h"
#include "src/runs/sweep_grid.h"

namespace needlework::cli {

/// Estimates of the members' wall times, good for comparing them [s].
std::vector<double> estimated_costs(const sweep::Grid& grid);

/// Share `k` of `m` (from 0) of these members, the longest first. Each goes to the share that has
/// least so far, so that shares take about the same time; they depend on nothing else.
std::vector<std::size_t> share_of(std::span<const std::size_t> members,
                                  std::span<const double> costs, std::size_t k, std::size_t m);

struct MemberRuns {
  const sweep::Grid& grid;
  const SweepFolder& folder;
  std::span<const std::size_t> members;  ///< to run, in this order
  std::span<const double> costs;         ///< of all members of the grid
  int threads = 1;                       ///< members at a time
  std::optional<std::string> isa;
  bool quiet = false;  ///< no progress
};

/// Runs them; errors are told with the member's name and concern no other. SIGINT and SIGTERM end
/// all of them within a fraction of a second. Puts the exit code of each into `exit_codes`, which
/// has one for each member of the grid: `stopped` also for those that another process is running.
void run_members(const MemberRuns& runs, std::span<int> exit_codes);

/// Throws InputError if there is not enough memory for the largest members side by side.
void require_memory(const MemberRuns& runs);

}  // namespace needlework::cli
