#include "src/cli/report_command.h"

#include "src/cli/messages.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"

namespace needlework::cli {

using enum runs::ExitCode;

int run(const report::Request& request) {
  runs::require_writable(request.out, request.force, request.out);
  for (const std::string& file : request.files) {
    runs::require_other_file(request.out, file, request.out);
  }
  if (const auto warning =
          warning_of_name(request.out, request.out, "a page of HTML", {".html", ".htm"})) {
    print_warning(*warning);
  }
  report::write_report(request);
  return ok;
}

}  // namespace needlework::cli
