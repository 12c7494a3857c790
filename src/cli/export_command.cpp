#include "src/cli/export_command.h"

#include "needlework/h5md.h"
#include "src/io/vtkhdf.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"

namespace needlework::cli {

using enum runs::ExitCode;

int run(const ExportArguments& arguments) {
  runs::require_writable(arguments.to, arguments.force, arguments.to);
  io::write_vtkhdf(arguments.to, arguments.force, io::read_last_frame(arguments.from));
  return ok;
}

}  // namespace needlework::cli
