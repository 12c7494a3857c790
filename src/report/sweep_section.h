// What a page says of the summary of a sweep.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "src/io/contents.h"
#include "src/report/arrays.h"
#include "src/report/thinning.h"

namespace needlework::report {

/// Reads a summary.h5: `grid`, `scene`, `version`, the `parameters` with a value for each point,
/// `members` at each point, `results` with mean and standard error for each point, and the `series`
/// of each point.
nlohmann::ordered_json sweep_section(const std::string& path, const io::Contents& contents,
                                     const PageLimits& limits, Arrays& arrays);

}  // namespace needlework::report
