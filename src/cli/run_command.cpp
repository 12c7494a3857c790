#include "src/cli/run_command.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "src/cli/messages.h"
#include "src/cli/progress.h"
#include "src/cli/report.h"
#include "src/cli/scene_arguments.h"
#include "src/cli/signals.h"
#include "src/cli/watch.h"
#include "src/runs/engine_choice.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"
#include "src/runs/prepared_run.h"
#include "src/runs/run_driver.h"
#include "src/scene/check.h"

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

int exit_code_of(const runs::Course& course, const Scene& scene) {
  if (course.failure) {
    print_error(fmt::format("{} ({})", *course.failure, where_saved(scene)));
    return invalid_state;
  }
  if (course.stop == Stop::interrupted || course.stop == Stop::wall_time) {
    print_error(fmt::format("stopped by {} at time {:.6g} after {} collisions ({})",
                            course.stop == Stop::wall_time ? "until.wall_s" : "a signal",
                            course.last.time, course.last.collisions,
                            where_saved(scene) + how_to_continue(scene)));
    return stopped;
  }
  return ok;
}

std::unique_ptr<runs::RunMonitor> make_monitor(const Scene& scene, const Printing& printing) {
  if (printing.watch) return std::make_unique<RunWatch>(scene);
  return std::make_unique<RunProgress>(printing.quiet);
}

}  // namespace

int run(const RunArguments& arguments) {
  SignalGuard signals;  // a signal during the set-up ends the run in order, too
  runs::LoadedScene loaded = load_scene(arguments.scene);
  Scene& scene = loaded.scene;
  if (arguments.out) {
    scene.output.file = *arguments.out;
    scene.places["output.file"] = "--out " + *arguments.out;
  }
  const std::string& file = scene.output.file;
  if (!file.empty()) {
    const std::string place = place_of(scene, "output.file", file);
    runs::require_writable(file, arguments.force, place);
    warn_of_name(place, file, {".h5", ".hdf5", ".h5md"});
  }
  for (const std::string& warning : runs::all_warnings(scene)) print_warning(warning);

  runs::PreparedRun prepared(std::move(loaded), arguments.force, arguments.scene.path);
  return drive(prepared, signals, arguments.printing);
}

int drive(runs::PreparedRun& prepared, SignalGuard& signals, const Printing& printing) {
  signals.interrupt(prepared.simulation());
  const auto monitor = make_monitor(prepared.scene(), printing);
  const runs::Course course = prepared.drive(*monitor);

  const Report report{prepared.scene(), prepared.simulation(), course, prepared.setup_s()};
  if (printing.json) {
    fmt::print("{}\n", json_of(report));
  } else if (!printing.quiet) {
    fmt::print("{}", summary_of(report));
  }
  return exit_code_of(course, prepared.scene());
}

}  // namespace needlework::cli
