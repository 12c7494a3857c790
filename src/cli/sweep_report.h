// The result of a sweep, as printed when it is over.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "src/runs/sweep_grid.h"
#include "src/runs/sweep_summary.h"

namespace needlework::cli {

/// The points of the grid with their means and standard errors.
nlohmann::ordered_json json_of(const runs::sweep::Grid& grid,
                               std::span<const runs::sweep::PointSummary> summary);

/// Values separated by commas, a line for each point: its parameters, how many members it has, and
/// of each result, by its name and as NAME_error, the mean and the standard error. What has a comma
/// or a quotation mark is quoted; what is not a number is empty.
std::string csv_of(const runs::sweep::Grid& grid,
                   std::span<const runs::sweep::PointSummary> summary);

/// A table for people, a line for each point.
std::string table_of(const runs::sweep::Grid& grid,
                     std::span<const runs::sweep::PointSummary> summary);

}  // namespace needlework::cli
