#include "src/cli/resume_command.h"

#include <optional>
#include <utility>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/cli/messages.h"
#include "src/cli/run_command.h"
#include "src/cli/set_up.h"
#include "src/cli/signals.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/prepared_run.h"
#include "src/scene/confinement.h"

namespace needlework::cli {
namespace {

// Other front ends name the end in each call.
void require_end(const Scene& scene, const std::string& file) {
  if (has_end(scene)) return;
  throw InputError(file +
                   ": the run has no end: expected --set until.KEY=VALUE with one of time, "
                   "collisions_per_needle, energy_ratio, wall_s");
}

}  // namespace

int run(const ResumeArguments& arguments) {
  SignalGuard signals;
  std::optional<SetUp> set_up(arguments.file + " is as it was");
  auto [saved, warning] = runs::load_checkpoint(arguments.file, [&](Scene& scene) {
    override_until(scene, arguments.overrides);
    require_end(scene, arguments.file);
    apply(arguments.engine, scene);
    set_up->limit(scene.until);
  });
  if (!warning.empty()) print_warning(warning);
  RunLog log = open_log(arguments.printing, arguments.file);
  return logged(log, [&, &from = saved, &of_checkpoint = warning] {
    runs::PreparedRun prepared(std::move(from));
    set_up.reset();
    log.start({}, prepared);
    if (!of_checkpoint.empty()) log.warning(of_checkpoint);
    return drive(prepared, signals, arguments.printing, log);
  });
}

}  // namespace needlework::cli
