#include "src/cli/resume_command.h"

#include <utility>

#include "needlework/parse.h"
#include "src/cli/messages.h"
#include "src/cli/run_command.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/prepared_run.h"

namespace needlework::cli {

int run(const ResumeArguments& arguments) {
  auto [saved, warning] = runs::load_checkpoint(arguments.file, [&](Scene& scene) {
    override_until(scene, arguments.overrides);
    apply(arguments.engine, scene);
  });
  if (!warning.empty()) print_warning(warning);
  runs::PreparedRun prepared(std::move(saved));
  return drive(prepared, arguments.printing);
}

}  // namespace needlework::cli
