#include "src/cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "src/cli/audit_command.h"
#include "src/cli/bench_command.h"
#include "src/cli/check_command.h"
#include "src/cli/export_command.h"
#include "src/cli/info_command.h"
#include "src/cli/messages.h"
#include "src/cli/predict_command.h"
#include "src/cli/run_command.h"
#include "src/cli/sweep_command.h"
#include "src/cli/theory_command.h"
#include "src/cli/version.h"
#include "src/runs/exit_codes.h"

namespace needlework::cli {

using enum runs::ExitCode;
namespace {

// A number from `least` to `most`. CLI::Range lets nan pass.
CLI::Validator number_in(double least, double most) {
  const std::string expected = fmt::format("a number from {:g} to {:g}", least, most);
  return {[=](const std::string& text) -> std::string {
            double value = 0;
            const bool fits =
                CLI::detail::lexical_cast(text, value) && least <= value && value <= most;
            return fits ? "" : fmt::format("{}: expected {}", text, expected);
          },
          expected};
}

void add_scene_arguments(CLI::App& command, SceneArguments& arguments) {
  command.add_option("SCENE", arguments.path, "scene file (TOML)")->required();
  command
      .add_option("--set", arguments.overrides,
                  "replace a key of the scene, such as needles.count=500; may be repeated")
      ->option_text("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--threads", arguments.engine.threads, "number of threads")
      ->option_text("N")
      ->check(CLI::Range(1, 1024));
  command
      .add_option("--isa", arguments.engine.isa,
                  "instruction set: auto, scalar, sse4, avx2 or avx512")
      ->option_text("NAME");
}

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

void add_sweep_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("sweep", "run a grid of parameters and seeds, and sum it up");
  const auto arguments = std::make_shared<SweepArguments>();
  command->add_option("GRID", arguments->grid, "grid file (TOML)")->required();
  command->add_option("--out", arguments->out, "folder for the results")->option_text("DIR");
  command->add_option("--threads", arguments->threads, "members to run at a time; default: cores")
      ->option_text("N")
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--isa", arguments->isa, "instruction set: auto, scalar, sse4, avx2 or avx512")
      ->option_text("NAME");
  command->add_option("--member", arguments->member, "run the K-th of M parts only")
      ->option_text("K/M");
  command->add_flag("--summary", arguments->summary, "run nothing, sum up what is there");
  command->add_flag("--json", arguments->json, "print the result as one JSON object");
  command->add_flag("--quiet", arguments->quiet, "no progress, no table");
  command->add_flag("--force", arguments->force,
                    "go on in a folder of another grid; members that differ are made anew");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_check_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("check", "explain a scene and what it will cost");
  const auto arguments = std::make_shared<CheckArguments>();
  add_scene_arguments(*command, arguments->scene);
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_theory_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<TheoryArguments>();
  CLI::App* command =
      app.add_subcommand("theory", "tell what kinetic theory predicts for a homogeneous gas");
  command->add_option("--epsilon", arguments->epsilon, "normal restitution, in [0, 1]")
      ->required()
      ->type_name("E");
  command
      ->add_option("--k", arguments->k,
                   "m L^2 / (2 I); 6 for a uniform rod, 2 for mass at the tips")
      ->required()
      ->type_name("K");
  command->add_option("--beta", arguments->beta, "tangential restitution, in [-1, 1]; -1 is smooth")
      ->capture_default_str()
      ->type_name("B");
  command->add_option("--t-rot0", arguments->t_rot0, "initial T_rot; the initial T_tr is 1")
      ->capture_default_str()
      ->type_name("X");
  command
      ->add_option("--tau", arguments->taus,
                   "time at which to print the temperatures, (2/3) sqrt(pi) n t; may be repeated")
      ->type_name("T");
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_predict_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("predict", "find the first contact of each pair of needles");
  const auto arguments = std::make_shared<PredictArguments>();
  command
      ->add_option("PAIRS", arguments->path, "pairs of needles, one a line; - reads standard input")
      ->option_text("PAIRS.csv")
      ->required();
  Scene::Engine& engine = arguments->engine;
  command->add_option("--accuracy", engine.accuracy, "level of accuracy")
      ->check(CLI::IsMember({"fast", "standard", "rigorous"}))
      ->capture_default_str();
  command->add_option("--isolation", engine.isolation, "how free times are told")
      ->check(CLI::IsMember({"sampling", "bounds", "intervals"}));
  command->add_option("--escalation", engine.escalation, "what goes to double-double")
      ->check(CLI::IsMember({"never", "undecided", "always"}));
  command
      ->add_option("--root-tolerance", engine.root_tolerance, "of steps towards a root, relative")
      ->check(number_in(0, 1e-3));
  command->add_option("--sampling-step", engine.sampling_step, "time between samples, scaled")
      ->check(number_in(1e-4, 0.5));
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(
      "A line of PAIRS.csv is id,family,horizon, then x,y,z of r1,u1,v1,w1,r2,u2,v2,w2, then "
      "skip:\n"
      "1 if the pair has just collided at time 0, else 0. For each the output has "
      "id,time,s12,s21,\n"
      "with time inf if there is no contact in (0, horizon].");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_audit_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("audit", "check each collision of a scene, and that none was missed");
  const auto arguments = std::make_shared<AuditArguments>();
  add_scene_arguments(*command, arguments->scene);
  command->add_option("--share", arguments->share, "share of all pairs to check")
      ->option_text("P")
      ->check(number_in(0, 1));
  command->add_option("--seed", arguments->seed, "says which pairs these are")
      ->option_text("N")
      ->check(number_in(0, 0x1p64));
  command->add_option("--state", arguments->state, "where an interrupted audit goes on from")
      ->option_text("FILE");
  command->add_flag("--json", arguments->json, "print the result as one JSON object");
  command->add_flag("--quiet", arguments->quiet, "no progress, no summary");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_info_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("info", "tell what an H5MD file holds");
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option("FILE", arguments->file, "H5MD file")->required();
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("export", "write the last frame of an H5MD file for ParaView and VTK");
  const auto arguments = std::make_shared<ExportArguments>();
  command->add_option("FILE", arguments->from, "H5MD file to read")->required();
  command->add_option("OUT", arguments->to, "VTKHDF file to write, called .vtkhdf")->required();
  command->add_flag("--force", arguments->force, "replace an existing file");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_bench_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = app.add_subcommand(
      "bench",
      "measure scenes by several searches, queues and instruction sets, against the "
      "classical method as baseline");
  command->add_option("SUBSET", arguments->subset, help_on_subsets())->option_text("[quick]");
  command->add_flag("--list", arguments->list, "list all subsets and their cases, measure nothing");
  command->add_option("--repetitions", arguments->repetitions, "of all cases in turn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--min-time", arguments->min_time,
                   "least CPU time of a case in each repetition [s]")
      ->check(number_in(0, 3600))
      ->capture_default_str();
  command
      ->add_option("--json", arguments->json_file,
                   "print the results as one JSON object, or write them to a file and print the "
                   "table")
      ->expected(0, 1)
      ->option_text("[FILE.json]");
  command->add_option("--compare", arguments->compare, "older results, to be compared with")
      ->option_text("OLD.json");
  command
      ->add_option("--results", arguments->results,
                   "take the results from a file instead of measuring")
      ->option_text("FILE.json");
  command->add_flag("--quiet", arguments->quiet, "no progress");
  command->add_flag("--force", arguments->force, "replace an existing file");
  command->footer(help_on_verdicts());
  command->callback([arguments, command, &exit_code] {
    arguments->json = command->count("--json") > 0;
    exit_code = run(*arguments);
  });
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app("Event-driven simulation of gases of hard needles", "needlework");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text, "tell version, compiler, CPU and libraries");
  int exit_code = ok;
  add_run_command(app, exit_code);
  add_sweep_command(app, exit_code);
  add_check_command(app, exit_code);
  add_theory_command(app, exit_code);
  add_predict_command(app, exit_code);
  add_audit_command(app, exit_code);
  add_info_command(app, exit_code);
  add_export_command(app, exit_code);
  add_bench_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help and --version
    print_error(fmt::format("{} (see needlework --help)", error.what()));
    return bad_usage;
  }
  return exit_code;
}

}  // namespace needlework::cli
