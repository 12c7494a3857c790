// How many cores the process may use, and what limits them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace needlework {

/// The cores that a process may use, by all that limits them.
struct AvailableCores {
  int online = 1;                     ///< cores of the machine
  int affinity = 1;                   ///< cores that the process may run on
  std::optional<double> quota;        ///< CPU time per time of its control group, if limited [1]
  std::filesystem::path quota_file;   ///< where that is written
  std::optional<int> slurm_per_task;  ///< SLURM_CPUS_PER_TASK

  /// The least of these, in whole cores, at least 1. A quota of 2.5 cores is 2: with three threads,
  /// all would be stopped for a part of each period, in which they wait for each other.
  int usable() const;

  /// What limits them, for readers: "2 of 8: CPU quota of 2.5 (/sys/fs/cgroup/cpu.max)".
  std::string text() const;
};

/// Those of this process, in this environment, as they are now. `affinity`: as OpenMP counts them.
/// The limits of control groups are read below `root`, which is elsewhere in tests.
AvailableCores available_cores(const std::filesystem::path& root = "/");

}  // namespace needlework
