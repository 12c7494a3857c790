#include "src/cli/report_command.h"

#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"

namespace needlework::cli {

using enum runs::ExitCode;

int run(const report::Request& request) {
  runs::require_writable(request.out, request.force, request.out);
  report::write_report(request);
  return ok;
}

}  // namespace needlework::cli
