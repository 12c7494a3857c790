// What a page says of one run.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "src/io/contents.h"
#include "src/report/arrays.h"
#include "src/report/thinning.h"

namespace needlework::report {

/// Reads an H5MD file: `parameters` (name, value, description), `scene` (keys of the scene that the
/// page names), `groups`: the totals, the theory and each observable of /series, with the rows
/// shown of how many, times, and datasets with shape, description and array; and `frames`. Of
/// time_correlation there is one row, see LagMeans, the mean of `mean_of_rows` or, at 0, the last.
nlohmann::ordered_json run_section(const std::string& path, const io::Contents& contents,
                                   const PageLimits& limits, Arrays& arrays);

}  // namespace needlework::report
