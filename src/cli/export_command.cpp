#include "src/cli/export_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "needlework/h5md.h"
#include "src/io/vtkhdf.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"

namespace needlework::cli {

void add_export_command(CLI::App& app, int& exit_code) {
  struct ExportArguments {
    std::string from, to;
    bool force = false;
  };
  CLI::App* command =
      app.add_subcommand("export", "write the last frame of an H5MD file for ParaView and VTK");
  const auto arguments = std::make_shared<ExportArguments>();
  command->add_option("FILE", arguments->from, "H5MD file to read")->required();
  command->add_option("OUT", arguments->to, "VTKHDF file to write, called .vtkhdf")->required();
  command->add_flag("--force", arguments->force, "replace an existing file");
  command->callback([arguments, &exit_code] {
    require_writable(arguments->to, arguments->force, arguments->to);
    io::write_vtkhdf(arguments->to, arguments->force, io::read_last_frame(arguments->from));
    exit_code = ok;
  });
}

}  // namespace needlework::cli
