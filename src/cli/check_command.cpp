#include "src/cli/check_command.h"

#include <fmt/format.h>

#include <memory>

#include "src/cli/messages.h"
#include "src/runs/exit_codes.h"
#include "src/runs/explanation.h"
#include "src/runs/output_path.h"
#include "src/runs/scene_source.h"
#include "src/scene/check.h"

namespace needlework::cli {

void add_check_command(CLI::App& app, int& exit_code) {
  struct CheckArguments {
    SceneArguments scene;
    bool json = false;
  };
  CLI::App* command = app.add_subcommand("check", "explain a scene and what it will cost");
  const auto arguments = std::make_shared<CheckArguments>();
  add_scene_arguments(*command, arguments->scene);
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->callback([arguments, &exit_code] {
    const LoadedScene loaded = load_scene(arguments->scene);
    const std::string& file = loaded.scene.output.file;
    if (!file.empty()) require_writable(file, true, place_of(loaded.scene, "output.file", file));
    const Explanation explanation(loaded);
    for (const std::string& warning : explanation.warnings) print_warning(warning);
    if (arguments->json) {
      fmt::print(
          "{}\n",
          json_of(explanation).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    } else {
      fmt::print("{}", text_of(explanation));
    }
    exit_code = ok;
  });
}

}  // namespace needlework::cli
