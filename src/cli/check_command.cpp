#include "src/cli/check_command.h"

#include <fmt/format.h>

#include "needlework/simulation.h"
#include "src/cli/check_report.h"
#include "src/cli/messages.h"
#include "src/cli/scene_arguments.h"
#include "src/runs/exit_codes.h"
#include "src/runs/explanation.h"
#include "src/runs/output_path.h"
#include "src/runs/prepared_run.h"

namespace needlework::cli {

using enum runs::ExitCode;

int run(const CheckArguments& arguments) {
  const runs::LoadedScene loaded = load_scene(arguments.scene);
  runs::require_writable_output(loaded.scene, true, arguments.scene.path);
  runs::require_events(loaded, arguments.scene.path);
  if (loaded.initial) require_simulable(loaded.scene, *loaded.initial);
  const runs::Explanation explanation(loaded);
  for (const std::string& warning : explanation.warnings) print_warning(warning);
  fmt::print("{}", arguments.json ? json_of(explanation) + '\n' : text_of(explanation));
  return ok;
}

}  // namespace needlework::cli
