#include "src/cli/run_command.h"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "src/cli/messages.h"
#include "src/cli/progress.h"
#include "src/cli/report.h"
#include "src/cli/scene_arguments.h"
#include "src/cli/set_up.h"
#include "src/cli/signals.h"
#include "src/cli/watch.h"
#include "src/io/write_lock.h"
#include "src/runs/engine_choice.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"
#include "src/runs/prepared_run.h"
#include "src/runs/run_driver.h"
#include "src/scene/check.h"
#include "src/scene/validity.h"

namespace needlework::cli {

using enum runs::ExitCode;
namespace {

std::string where_saved(const Scene& scene) {
  const std::string& file = scene.output.file;
  if (file.empty()) return "nothing is saved, as no output file is named";
  return "saved in " + file;
}

// Empty if the run cannot be continued.
std::string how_to_continue(const Scene& scene) {
  const std::string& file = scene.output.file;
  if (file.empty() || scene.output.checkpoint_every == 0) return "";
  return fmt::format("; needlework resume {} continues", shell_word(file));
}

// The message of a run that has not got to its end.
struct Ending {
  runs::ExitCode exit_code = ok;
  std::string message = {};
};

Ending ending_of(const runs::RunResult& result, const Scene& scene) {
  if (result.failure) {
    const std::string replay =
        result.bundle.empty()
            ? ""
            : fmt::format("; needlework replay {} shows it again", shell_word(result.bundle));
    return {invalid_state, fmt::format("{} ({}{})", *result.failure, where_saved(scene), replay)};
  }
  if (result.stop == Stop::interrupted || result.stop == Stop::wall_time) {
    return {stopped, fmt::format("stopped by {} at time {:.6g} after {} collisions ({})",
                                 result.stop == Stop::wall_time ? "until.wall_s" : "a signal",
                                 result.last.time, result.last.collisions,
                                 where_saved(scene) + how_to_continue(scene))};
  }
  return {};
}

std::unique_ptr<runs::RunMonitor> make_monitor(const Scene& scene, const Printing& printing) {
  if (printing.watch) return std::make_unique<RunWatch>(scene);
  return std::make_unique<RunProgress>(printing.quiet, printing.progress_every);
}

// Prints the warnings about a scene that is about to be run.
std::vector<std::string> warn(const runs::LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  std::vector<std::string> warnings = runs::all_warnings(loaded);
  const std::string& file = scene.output.file;
  const std::string place = place_of(scene, "output.file", file);
  const auto of_name = warning_of_name(place, file, "an HDF5 file", {".h5", ".hdf5", ".h5md"});
  if (!file.empty() && of_name) warnings.insert(warnings.begin(), *of_name);
  for (const std::string& warning : warnings) print_warning(warning);
  return warnings;
}

bool is_at(const Simulation& simulation, double time, std::uint64_t collisions) {
  return simulation.time() == time && simulation.collisions() == collisions;
}

// What to do where the end of a run is met already.
std::string nothing_to_do(Stop end) {
  const bool is_set =
      end == Stop::time || end == Stop::collisions || end == Stop::energy || end == Stop::wall_time;
  return fmt::format("the end of the run is met already: nothing to do; {}",
                     is_set ? "--set until.KEY=VALUE sets another end, --set until.KEY=none "
                              "removes one"
                            : "a new scene with initial.file goes on from its last state");
}

}  // namespace

RunLog open_log(const Printing& printing, const std::string& output_file) {
  return printing.log ? RunLog(*printing.log, output_file) : RunLog();
}

int run(const RunArguments& arguments) {
  SignalGuard signals;
  std::optional<SetUp> set_up("nothing is saved");
  const Printing& printing = arguments.printing;
  if (!printing.quiet && !printing.json) set_up->show_progress(printing.progress_every);
  runs::LoadedScene loaded = load_scene(arguments.scene, &*set_up);
  Scene& scene = loaded.scene;
  if (arguments.out) {
    scene.output.file = *arguments.out;
    scene.places["output.file"] = "--out " + *arguments.out;
  }
  const std::string file = scene.output.file;
  if (!file.empty()) {
    const std::string place = place_of(scene, "output.file", file);
    runs::require_writable_output(scene, arguments.force, arguments.scene.path);
    io::require_not_being_written(file, place + ": cannot be replaced");
  }
  require_rules(scene, Aspect::end);
  const std::vector<std::string> warnings = warn(loaded);
  RunLog log = open_log(arguments.printing, file);
  return logged(log, [&] {
    runs::PreparedRun prepared(std::move(loaded), arguments.force, arguments.scene.path);
    set_up.reset();
    log.start(arguments.scene.path, prepared);
    for (const std::string& warning : warnings) log.warning(warning);
    return drive(prepared, signals, arguments.printing, log);
  });
}

int drive(runs::PreparedRun& prepared, SignalGuard& signals, const Printing& printing,
          RunLog& log) {
  signals.interrupt(prepared.simulation());
  if (const std::string warning = prepared.warning(); !warning.empty()) {
    print_warning(warning);
    log.warning(warning);
  }
  const auto shown = make_monitor(prepared.scene(), printing);
  LoggedRun with_log(*shown, log, printing.progress_every.value_or(log_interval));
  runs::RunMonitor& monitor = log ? static_cast<runs::RunMonitor&>(with_log) : *shown;
  const double time = prepared.simulation().time();
  const std::uint64_t collisions = prepared.simulation().collisions();
  const runs::RunResult result = prepared.drive(monitor, runs::seconds_since_launch());

  const Report report{prepared.scene(), prepared.simulation(), result,
                      prepared.setup_s() + result.setup.wall()};
  if (printing.json) {
    fmt::print("{}\n", json_of(report));
  } else if (!printing.quiet) {
    fmt::print("{}", summary_of(report));
  }
  const Ending ending = ending_of(result, prepared.scene());
  if (!ending.message.empty()) print_error(ending.message);
  if (result.stop == Stop::nothing_can_happen) {
    const std::string why = fmt::format("the run has ended early, as nothing collides: {}",
                                        prepared.simulation().why_no_collision());
    print_warning(why);
    log.warning(why);
  } else if (ending.exit_code == ok && time > 0 && is_at(prepared.simulation(), time, collisions)) {
    print_warning(nothing_to_do(result.stop));
    log.warning(nothing_to_do(result.stop));
  }
  log.end(prepared, result, ending.exit_code, ending.message);
  return ending.exit_code;
}

}  // namespace needlework::cli
