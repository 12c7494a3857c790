// `needlework report`: runs, sweeps and benchmarks as a page for a browser.
#pragma once

#include "src/report/report.h"

namespace needlework::cli {

/// Returns the exit code.
int run(const report::Request& request);

}  // namespace needlework::cli
