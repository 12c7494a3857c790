#include "src/cli/resume_command.h"

#include <utility>

#include "needlework/parse.h"
#include "src/cli/messages.h"
#include "src/cli/run_command.h"
#include "src/runs/checkpoint.h"
#include "src/runs/engine_choice.h"
#include "src/runs/prepared_run.h"

namespace needlework::cli {

int run(const ResumeArguments& arguments) {
  auto [saved, warning] = runs::CheckpointFiles(arguments.file).read();
  if (!warning.empty()) print_warning(warning);
  Scene& scene = saved.scene;
  // The file may have been moved since.
  scene.output.file = scene.places["output.file"] = arguments.file;
  override_until(scene, arguments.overrides);
  // This may be another machine.
  scene.engine.isa = "auto";
  apply(arguments.engine, scene);
  runs::choose_engine(scene);

  runs::PreparedRun prepared(std::move(saved));
  return drive(prepared, arguments.printing);
}

}  // namespace needlework::cli
