// Runs, sweeps and benchmark results as one page that a browser opens from disk.
#pragma once

#include <string>
#include <vector>

#include "src/report/thinning.h"

namespace needlework::report {

struct Request {
  std::vector<std::string> files;  ///< H5MD files of runs, summaries of sweeps, results in JSON
  std::string out;                 ///< page to write
  std::string title;               ///< empty: that of the first run
  bool force = false;              ///< whether to replace an existing page
  PageLimits limits;
};

/// Writes the page. The same files make the same bytes. Throws InputError for a file of another
/// kind or with wrong content, and IoError for one that cannot be read or written; then there is no
/// page, and an existing one is as it was.
void write_report(const Request& request);

}  // namespace needlework::report
