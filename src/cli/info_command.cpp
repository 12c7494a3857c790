#include "src/cli/info_command.h"

#include <fmt/format.h>

#include "needlework/h5md.h"
#include "src/cli/file_kind.h"
#include "src/runs/exit_codes.h"

namespace needlework::cli {

using enum runs::ExitCode;

int run(const InfoArguments& arguments) {
  std::string text =
      read_file(arguments.file, FileKind::h5md, [&] { return io::describe(arguments.file); });
  if (!text.empty() && text.back() != '\n') text += '\n';
  fmt::print("{}", text);
  return ok;
}

}  // namespace needlework::cli
