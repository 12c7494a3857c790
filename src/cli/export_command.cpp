#include "src/cli/export_command.h"

#include "needlework/h5md.h"
#include "src/cli/file_kind.h"
#include "src/cli/messages.h"
#include "src/io/vtkhdf.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"

namespace needlework::cli {

using enum runs::ExitCode;

int run(const ExportArguments& arguments) {
  runs::require_writable(arguments.to, arguments.force, arguments.to);
  const State state = read_file(arguments.from, FileKind::h5md,
                                [&] { return io::read_last_frame(arguments.from); });
  warn_of_name("OUT.vtkhdf " + arguments.to, arguments.to, {".vtkhdf", ".hdf"});
  io::write_vtkhdf(arguments.to, arguments.force, state);
  return ok;
}

}  // namespace needlework::cli
