#include "src/cli/info_command.h"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "needlework/h5md.h"
#include "src/runs/exit_codes.h"

namespace needlework::cli {

void add_info_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("info", "tell what an H5MD file holds");
  const auto path = std::make_shared<std::string>();
  command->add_option("FILE", *path, "H5MD file")->required();
  command->callback([path, &exit_code] {
    std::string text = io::describe(*path);
    if (!text.empty() && text.back() != '\n') text += '\n';
    fmt::print("{}", text);
    exit_code = ok;
  });
}

}  // namespace needlework::cli
