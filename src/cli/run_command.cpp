#include "src/cli/run_command.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "src/cli/drive.h"
#include "src/cli/exit_codes.h"
#include "src/cli/messages.h"
#include "src/cli/output_path.h"
#include "src/cli/report.h"
#include "src/cli/scene_source.h"
#include "src/cli/signals.h"
#include "src/error.h"
#include "src/io/h5md.h"
#include "src/scene/check.h"

namespace needlework::cli {
namespace {

struct RunArguments {
  SceneArguments scene;
  std::optional<std::string> out;
  bool json = false, quiet = false, force = false;
};

Simulation make_simulation(const LoadedScene& loaded) {
  return loaded.initial ? Simulation(loaded.scene, *loaded.initial) : Simulation(loaded.scene);
}

void require_events(Simulation& simulation, const Scene& scene, const std::string& path) {
  if (scene.until.time) return;
  Scene::Until at_once;
  at_once.collisions_per_needle = 0;
  if (simulation.advance(at_once) == Stop::nothing_can_happen) {
    throw InputError(path + ": nothing can ever happen: expected needles that move, or until.time");
  }
}

std::string where_saved(const Scene& scene) {
  const std::string& file = scene.output.file;
  return file.empty() ? "nothing is saved, as no output file is named" : "saved in " + file;
}

int exit_code_of(const Course& course, const Scene& scene) {
  if (course.failure) {
    print_error(fmt::format("{} ({})", *course.failure, where_saved(scene)));
    return invalid_state;
  }
  if (course.stop == Stop::interrupted || course.stop == Stop::wall_time) {
    print_error(fmt::format("stopped by {} at time {:.6g} after {} collisions ({})",
                            course.stop == Stop::wall_time ? "until.wall_s" : "a signal",
                            course.last.time, course.last.collisions, where_saved(scene)));
    return stopped;
  }
  return ok;
}

io::Writer open_output(const Simulation& simulation, const Scene& scene, bool force) {
  const std::string& file = scene.output.file;
  try {
    return io::Writer(file, force, scene,
                      io::RunInfo{.isa = simulation.isa(),
                                  .threads = scene.engine.threads.value_or(1),
                                  .epoch_length = simulation.epoch_length()});
  } catch (const IoError& error) {
    throw IoError(fmt::format("{}: cannot be written: {}", place_of(scene, "output.file", file),
                              error.what()));
  }
}

int run(const RunArguments& arguments) {
  LoadedScene loaded = load_scene(arguments.scene);
  Scene& scene = loaded.scene;
  if (arguments.out) {
    scene.output.file = *arguments.out;
    scene.places["output.file"] = "--out " + *arguments.out;
  }
  const std::string& file = scene.output.file;
  if (!file.empty()) require_writable(file, arguments.force, place_of(scene, "output.file", file));
  for (const std::string& warning : warnings(scene)) print_warning(warning);

  Stopwatch setup;
  setup.start();
  Simulation simulation = make_simulation(loaded);
  loaded.initial.reset();
  setup.stop();
  require_events(simulation, scene, arguments.scene.path);

  std::optional<io::Writer> writer;
  if (!file.empty()) writer.emplace(open_output(simulation, scene, arguments.force));
  const SignalGuard guard(simulation);
  Progress progress(arguments.quiet);
  const Course course = Drive(simulation, scene, writer ? &*writer : nullptr, progress).run();
  if (writer) writer->close();

  const Report report{scene, simulation, course, setup.wall()};
  if (arguments.json) {
    fmt::print("{}\n",
               json_of(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (!arguments.quiet) {
    fmt::print("{}", summary_of(report));
  }
  return exit_code_of(course, scene);
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("run", "simulate a scene");
  const auto arguments = std::make_shared<RunArguments>();
  add_scene_arguments(*command, arguments->scene);
  command->add_option("--out", arguments->out, "H5MD file to write")->option_text("FILE.h5");
  command->add_flag("--json", arguments->json, "print the result as one JSON object");
  command->add_flag("--quiet", arguments->quiet, "no progress, no summary");
  command->add_flag("--force", arguments->force, "replace an existing output file");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace needlework::cli
