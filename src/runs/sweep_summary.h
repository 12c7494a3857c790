// What the members of a sweep have in common: means over seeds, with their standard errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "needlework/h5md.h"
#include "src/runs/sweep_grid.h"

namespace needlework::runs::sweep {

/// A mean over seeds with its standard error, sqrt(sum (x - mean)^2 / (n (n - 1))); NaN for the
/// mean of nothing and for the error of less than two.
struct Estimate {
  double mean = 0;
  double standard_error = 0;
};

/// The estimate from independent numbers, summed in their order.
Estimate estimate(std::span<const double> values);

/// A number of the runs by its name.
struct Result {
  std::string name;
  Estimate estimate;
};

/// A sum over all needles by its name, as a function of time.
struct Series {
  std::string name;
  std::size_t width = 1;            ///< components: 3 of a vector, else 1
  std::vector<Estimate> estimates;  ///< [times][width]
};

/// A point of the grid.
struct PointSummary {
  std::vector<std::uint64_t> seeds;  ///< of the members that the means are over
  std::vector<Result> results;       ///< at the ends of the runs
  std::vector<double> times;         ///< samples that all these members have
  std::vector<Series> series;
};

/// Gives the finished run of a member, none if there is none.
using FinishedRun = std::function<std::optional<io::RecordedRun>(const Member&)>;

/// Sums up what is there of a sweep, point by point in the order of the grid. A pure function of
/// the runs: in which order they ended, and where, is not in it.
///
/// A series has the samples that all members of its point have at the same times. What lies beyond
/// the end of the shortest run is left out, as the others would be a biased choice.
std::vector<PointSummary> summarise(const Grid& grid, const FinishedRun& finished_run);

/// Writes the summary in HDF5, P points:
///
///   /sweep        grid, scene (texts), version
///   /parameters   a dataset [P] for each varied key, "section.key": numbers, or else text in TOML
///   /members      count [P]; seeds, of all members one after the other, and point, their points
///   /results      the totals but for vectors, collisions_per_needle, collision_rate and
///                 energy_ratio at the ends of the runs: each a group with mean [P] and
///                 standard_error [P]; of each wall hits_z_low, impulse_z_low, pressure_z_low
///                 and budget_z_low, and with walls or driving budget_pairs, budget_thermostat,
///                 budget_kicks, budget_gravity, budget_shear,
///                 budget_growth and budget_cooling; where bodies grow growth_NAME and
///                 network_NAME of the numbers of /series/growth and /series/contact_network
///   /series       a group for each point, 00000, 00001, ...: time [S], and the sums over all
///                 needles, each a group with mean and standard_error [S], [S][3] of vectors
///
/// The same summary makes the same bytes. An existing file is replaced, in one step. Throws
/// IoError.
void write_summary(const std::string& path, const Grid& grid,
                   std::span<const PointSummary> summary);

}  // namespace needlework::runs::sweep
