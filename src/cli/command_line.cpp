#include "src/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "src/cli/audit_command.h"
#include "src/cli/bench_command.h"
#include "src/cli/check_command.h"
#include "src/cli/export_command.h"
#include "src/cli/frame_choice.h"
#include "src/cli/import_command.h"
#include "src/cli/info_command.h"
#include "src/cli/messages.h"
#include "src/cli/predict_command.h"
#include "src/cli/ranks.h"
#include "src/cli/reference.h"
#include "src/cli/report_command.h"
#include "src/cli/reproduce_command.h"
#include "src/cli/resume_command.h"
#include "src/cli/run_command.h"
#include "src/cli/sweep_command.h"
#include "src/cli/theory_command.h"
#include "src/cli/usage.h"
#include "src/cli/version.h"
#include "src/cli/view_command.h"
#include "src/cli/watch.h"
#include "src/picture/needle_values.h"
#include "src/runs/exit_codes.h"
#include "src/serve/server.h"

namespace needlework::cli {

using enum runs::ExitCode;

namespace {

template <class Number>
std::string number_text(Number number) {
  return fmt::format("{:g}", static_cast<double>(number));
}

// A number from `least` to `most`. CLI::Range lets nan pass.
template <class Number>
CLI::Validator number_in(Number least, Number most) {
  const std::string expected =
      fmt::format("{} from {} to {}", std::is_integral_v<Number> ? "a whole number" : "a number",
                  number_text(least), number_text(most));
  return {[=](const std::string& text) -> std::string {
            Number value = 0;
            const bool fits =
                CLI::detail::lexical_cast(text, value) && least <= value && value <= most;
            return fits ? "" : fmt::format("{}: expected {}", text, expected);
          },
          "NUMBER"};
}

CLI::Validator one_of(std::vector<std::string> words) {
  return {[=](const std::string& text) -> std::string {
            const bool known = std::find(words.begin(), words.end(), text) != words.end();
            return known ? "" : fmt::format("{}: expected one of {}", text, fmt::join(words, ", "));
          },
          "WORD"};
}

// The words in lines of at most 78 characters.
std::string filled(const std::string& text) {
  std::istringstream words(text);
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > 78) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return lines + line;
}

// An option with one of these words as its value.
void add_choice(CLI::Option* option, const std::vector<std::string>& words) {
  option->option_text(fmt::format("{}", fmt::join(words, "|")))->check(one_of(words));
}

void add_scene(CLI::App& command, std::string& path, std::vector<std::string>& overrides,
               bool required) {
  command.add_option("SCENE.toml", path, "scene file")->required(required);
  command
      .add_option("--set", overrides,
                  "replace a key of the scene, such as needles.count=500; may be repeated")
      ->option_text("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
}

void add_isa(CLI::App& command, std::optional<std::string>& isa) {
  command.add_option("--isa", isa, "instruction set; auto is the widest of this CPU")
      ->option_text("auto|scalar|sse4|avx2|avx512");
}

void add_engine_options(CLI::App& command, EngineOptions& engine) {
  command.add_option("--threads", engine.threads, "number of threads")
      ->option_text("N")
      ->check(number_in(1, 1024));
  add_isa(command, engine.isa);
}

void add_scene_arguments(CLI::App& command, SceneArguments& arguments) {
  add_scene(command, arguments.path, arguments.overrides, true);
  add_engine_options(command, arguments.engine);
}

CLI::Validator terminal_on_stderr() {
  return {[](const std::string&) -> std::string {
            return can_watch() ? ""
                               : "expected a terminal on standard error, and its name in TERM; "
                                 "without --watch, a line is printed every 10 s";
          },
          "TERMINAL"};
}

void add_printing(CLI::App& command, Printing& printing) {
  command.add_flag("--json", printing.json, "print the result as one JSON object");
  CLI::Option* quiet = command.add_flag("--quiet", printing.quiet, "no progress, no summary");
  command
      .add_flag("--watch", printing.watch,
                "draw energy, T_tr/T_rot and collision rate on the terminal while the run lasts")
      ->excludes(quiet)
      ->check(terminal_on_stderr());
}

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("run", "simulate a scene");
  const auto arguments = std::make_shared<RunArguments>();
  add_scene_arguments(*command, arguments->scene);
  command->add_option("--out", arguments->out, "HDF5 file (H5MD) to write the run to")
      ->option_text("FILE.h5");
  add_printing(*command, arguments->printing);
  command->add_flag("--force", arguments->force, "replace an existing output file");
  command->footer(R"(Prints a summary: how the run ended, its energy and temperatures beside those
of theory, and what it cost. Without --out and without output.file in the
scene, no file is written. --watch needs a terminal.

Examples:
  needlework run profiles/quickstart.toml
  needlework run scene.toml --set collisions.epsilon=0.9 --out cooling.h5)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_resume_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("resume", "continue a run that has ended or was stopped");
  const auto arguments = std::make_shared<ResumeArguments>();
  command->add_option("FILE.h5", arguments->file, "output file of the run")->required();
  command
      ->add_option("--set", arguments->overrides,
                   "replace an end of the run, such as until.time=100; may be repeated")
      ->option_text("until.KEY=VALUE")
      ->allow_extra_args(false);
  add_engine_options(*command, arguments->engine);
  add_printing(*command, arguments->printing);
  command->footer(R"(The run continues from its last checkpoint, FILE.h5.checkpoint, and appends to
FILE.h5, with the same collisions as if it had never been stopped. The ends in
[until] count from the start of the run, except wall_s, which counts from now.

Examples:
  needlework resume cooling.h5
  needlework resume cooling.h5 --set until.time=1e6 --threads 2)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_sweep_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "sweep", "run a scene for each point of a grid of parameters and each seed");
  const auto arguments = std::make_shared<SweepArguments>();
  command->add_option("GRID.toml", arguments->grid, "grid file")->required();
  command
      ->add_option("--out", arguments->out, "folder for the results, in place of out in the grid")
      ->option_text("DIR");
  command
      ->add_option("--threads", arguments->threads,
                   "number of members that run at a time; by default, the number of cores")
      ->option_text("N")
      ->check(number_in(1, 1024));
  add_isa(*command, arguments->isa);
  command->add_option("--member", arguments->member, "run only part K of M")->option_text("K/M");
  command->add_flag("--summary", arguments->summary,
                    "run nothing; sum up the members that are finished");
  command->add_flag("--json", arguments->json, "print the result as one JSON object");
  command->add_flag("--quiet", arguments->quiet, "no progress, no table");
  command->add_flag("--force", arguments->force,
                    "continue in the folder of another grid; members that differ are run again");
  command->footer(R"(A member is one run: a point of the grid with one of the seeds. The same
command continues a sweep that was stopped. Means and standard errors over the
seeds are printed and written to summary.h5.

Examples:
  needlework sweep profiles/sweep-cooling.toml --out cooling-sweep
  needlework sweep grid.toml --out results --member 3/16)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_reproduce_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("reproduce", "make the figures of the paper and check its claims");
  const auto arguments = std::make_shared<ReproduceArguments>();
  add_choice(
      command->add_option("FIGURE", arguments->figure, "a figure of the paper, or all")->required(),
      names_of_figures());
  command->add_flag("--quick", arguments->quick,
                    "smaller systems, fewer seeds: at most 15 minutes");
  command
      ->add_option("--out", arguments->out,
                   "folder for runs, data and pictures; by default reproduction, or "
                   "reproduction-quick")
      ->option_text("DIR");
  command
      ->add_option("--threads", arguments->threads,
                   "number of runs at a time; by default, the number of cores")
      ->option_text("N")
      ->check(number_in(1, 1024));
  command->add_flag("--json", arguments->json, "print the claims as one JSON object");
  command->add_flag("--quiet", arguments->quiet, "no progress, no table");
  command->add_flag("--force", arguments->force,
                    "use a folder with something else in it; runs that differ are run again");
  command->footer(R"(The paper is "Granular cooling of hard needles" by Huthmann, Aspelmeier and
Zippelius. Runs that are finished are used again; the same command continues
after an interruption. For each figure, its data (CSV) and picture (SVG) are
written, and each claim is compared with the measurement: it agrees within three
standard errors plus the paper's precision, differs, or is open.

Examples:
  needlework reproduce 3 --quick
  needlework reproduce all --out reproduction)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_check_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("check", "explain a scene, and estimate its time and memory");
  const auto arguments = std::make_shared<CheckArguments>();
  add_scene_arguments(*command, arguments->scene);
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(R"(Runs nothing and writes nothing. What is expected of the run follows from
kinetic theory.

Examples:
  needlework check profiles/quickstart.toml)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_theory_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<TheoryArguments>();
  CLI::App* command =
      app.add_subcommand("theory", "print what kinetic theory predicts for a homogeneous gas");
  add_scene(*command, arguments->scene, arguments->overrides, false);
  command->add_option("--epsilon", arguments->epsilon, "normal restitution, from 0 to 1")
      ->option_text("E");
  command
      ->add_option("--k", arguments->k,
                   "m L^2 / (2 I): 6 for a uniform rod, 2 for all mass at the tips")
      ->option_text("K");
  command
      ->add_option("--beta", arguments->beta,
                   "tangential restitution, from -1 (smooth, the default) to 1")
      ->option_text("B");
  command
      ->add_option("--t-rot0", arguments->t_rot0,
                   "initial T_rot, by default 1; the initial T_tr is 1 without a scene")
      ->option_text("X");
  command
      ->add_option("--tau", arguments->taus,
                   "print the temperatures at this scaled time; may be repeated")
      ->option_text("T")
      ->allow_extra_args(true);
  command
      ->add_option("--time", arguments->times,
                   "print them at this time; needs a density; may be repeated")
      ->option_text("T");
  command->add_option("--density", arguments->density, "needles per unit of volume")
      ->option_text("N");
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(R"(Takes epsilon, k, beta, the density and the initial temperatures from the
scene, if one is given; options come first. Without a scene, --epsilon and
--k are needed.

tau = (2/3) sqrt(pi) n t is the time t scaled by the density n, so that the
cooling curve is the same for every density. c is the ratio T_tr / T_rot that
a gas tends to as it cools, and k_star the k at which c = 1 for every epsilon
(smooth needles).

Examples:
  needlework theory profiles/quickstart.toml
  needlework theory --epsilon 0.8 --k 6 --density 0.72 --time 10 --time 100)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_predict_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("predict", "find the first contact of each pair of needles");
  const auto arguments = std::make_shared<PredictArguments>();
  command
      ->add_option("PAIRS.csv", arguments->path,
                   "pairs of needles, one a line; - reads standard input")
      ->required();
  Scene::Engine& engine = arguments->engine;
  add_choice(command
                 ->add_option("--accuracy", engine.accuracy,
                              "level of accuracy; the options below depart from it")
                 ->capture_default_str(),
             {"fast", "standard", "rigorous"});
  add_choice(
      command->add_option("--isolation", engine.isolation, "how the first root is bracketed"),
      {"sampling", "bounds", "intervals"});
  add_choice(command->add_option("--escalation", engine.escalation,
                                 "which decisions are made in double-double arithmetic"),
             {"never", "undecided", "always"});
  command
      ->add_option("--root-tolerance", engine.root_tolerance,
                   "relative size of the last step towards a root, from 0 to 1e-3")
      ->option_text("X")
      ->check(number_in(0.0, 1e-3));
  command
      ->add_option("--sampling-step", engine.sampling_step,
                   "time between samples in the pair's own unit, from 1e-4 to 0.5")
      ->option_text("X")
      ->check(number_in(1e-4, 0.5));
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(R"(A line of PAIRS.csv is id,family,horizon, then x,y,z of r1,u1,v1,w1,r2,u2,
v2,w2, then skip: 1 if the pair has just collided at time 0, else 0. Lines that
begin with # are comments. For each pair the output has id,time,s12,s21, with
time inf if there is no contact in (0, horizon].

Examples:
  needlework predict pairs.csv --accuracy rigorous --json)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_audit_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "audit",
      "run a scene and check by independent arithmetic that no collision is missed or wrong");
  const auto arguments = std::make_shared<AuditArguments>();
  add_scene_arguments(*command, arguments->scene);
  command
      ->add_option("--share", arguments->share, "share of all pairs to check, from 0 to 1, drawn")
      ->option_text("P")
      ->check(number_in(0.0, 1.0));
  command->add_option("--seed", arguments->seed, "seed by which these pairs are drawn")
      ->option_text("N")
      ->check(number_in(0.0, 0x1p64));
  command
      ->add_option("--state", arguments->state,
                   "file in which an interrupted audit is kept, and from which it continues")
      ->option_text("FILE");
  command->add_flag("--json", arguments->json, "print the result as one JSON object");
  command->add_flag("--quiet", arguments->quiet, "no progress, no summary");
  command->footer(R"(Exit code 1: differences were found.

Examples:
  needlework audit scene.toml --set needles.count=200)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_serve_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("serve", "simulate for a front end over a pipe");
  command->footer(R"(Reads requests from standard input and answers on standard output, both as one
JSON object a line: create, advance, run_until, totals, state, velocities,
close, interrupt, quit. Ends after quit, or at the end of its input when all
requests are answered. docs/serve.md describes the requests.

Example:
  echo '{"do": "create", "path": "profiles/quickstart.toml"}' | needlework serve)");
  command->callback([&exit_code] {
    serve::serve(std::cin, std::cout);
    exit_code = ok;
  });
}

void add_info_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("info", "list what an H5MD file holds");
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option("FILE.h5", arguments->file, "H5MD file")->required();
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_import_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "import", "make a scene and a state of a configuration of another program");
  const auto arguments = std::make_shared<ImportArguments>();
  command
      ->add_option("FILE", arguments->from,
                   "configuration of DynamO (.xml or .xml.bz2), extended XYZ, or dump or data file "
                   "of LAMMPS")
      ->required();
  command->add_option("--out", arguments->folder, "folder for scene.toml and state.h5")
      ->option_text("DIR")
      ->required();
  command->add_flag("--force", arguments->force, "replace existing files");
  command->footer(R"(Nothing is rescaled. What needles do not have, such as other interactions,
several species, gravity or walls, is an error that names its place. Of several
frames the last is taken. The end of the run is not in such a file: choose one in
[until] of scene.toml.

Examples:
  needlework import config.xml.bz2 --out lines
  needlework run lines/scene.toml --out lines/run.h5)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

CLI::Validator frame_choice() {
  return {[](const std::string& text) -> std::string {
            return is_frame_choice(text)
                       ? ""
                       : fmt::format("{}: expected a number from 0, first, last or all", text);
          },
          "FRAME"};
}

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("export", "write frames of an H5MD file in the format of another program");
  const auto arguments = std::make_shared<ExportArguments>();
  command->add_option("FILE.h5", arguments->from, "H5MD file to read")->required();
  command->add_option("OUT", arguments->to, "file to write; its ending is that of its format")
      ->option_text("FILE")
      ->required();
  add_choice(command->add_option("--to", arguments->format, "format, whatever the ending of OUT"),
             names_of_export_formats());
  command
      ->add_option("--frame", arguments->frame,
                   "which frames, counted from 0; by default all, or the last where a format holds "
                   "one")
      ->option_text("N|first|last|all")
      ->check(frame_choice());
  command->add_flag("--force", arguments->force, "replace existing files");
  command->footer(R"(Formats:
  vtkhdf  .vtkhdf             one frame   ParaView and VTK
  pvd     .pvd                all frames  ParaView; one .vtu file for each in a folder beside it
  xyz     .xyz, .extxyz       all frames  extended XYZ: ASE, OVITO
  lammps  .dump, .lammpstrj   all frames  dump of LAMMPS
  lammps  .data, .lmp         one frame   data file of LAMMPS
  dynamo  .xml, .xml.bz2      one frame   configuration of DynamO

Examples:
  needlework export run.h5 run.pvd
  needlework export run.h5 start.xml.bz2 --frame first)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("report", "write runs, sweeps and benchmarks as one page for a browser");
  const auto request = std::make_shared<report::Request>();
  command
      ->add_option("FILES", request->files,
                   "H5MD files of runs, summary.h5 of sweeps, results of benchmarks in JSON")
      ->option_text("FILE...")
      ->required();
  command->add_option("-o,--out", request->out, "page to write")
      ->option_text("FILE.html")
      ->required();
  command->add_option("--title", request->title, "title of the page, by default that of the run")
      ->option_text("TEXT");
  command->add_option("--needles", request->limits.needles, "most needles shown of a frame")
      ->option_text("N")
      ->check(number_in(1, 1000000))
      ->capture_default_str();
  command->add_option("--frames", request->limits.frames, "most frames shown of a run")
      ->option_text("N")
      ->check(number_in(1, 100000))
      ->capture_default_str();
  command->add_flag("--force", request->force, "replace an existing page");
  command->footer(R"(The page holds its data and needs no network: charts with a table behind each,
and the needles of the frames in three dimensions. Of long runs it shows a part,
and says so: at most 600000 needles in all frames together.

Examples:
  needlework report run.h5 -o run.html
  needlework report sweep/summary.h5 bench.json -o results.html --title Results)");
  command->callback([request, &exit_code] { exit_code = run(*request); });
}

void add_view_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("view", "draw the needles of an H5MD file, without a display");
  const auto arguments = std::make_shared<ViewArguments>();
  picture::NeedlePicture& picture = arguments->picture;
  command->add_option("FILE.h5", arguments->from, "H5MD file to read")->required();
  command->add_option("-o,--out", arguments->to, "picture to write, PNG or SVG by its ending")
      ->option_text("FILE.png|FILE.svg")
      ->required();
  command
      ->add_option("--frame,--frames", arguments->frame,
                   "which frame, counted from 0; all writes FILE-00000.png and so on")
      ->option_text("N|first|last|all")
      ->check(frame_choice())
      ->capture_default_str();
  add_choice(
      command->add_option("--colour,--color", picture.colour, "what the colours of needles show")
          ->capture_default_str(),
      picture::quantities());
  add_choice(command->add_option("--projection", arguments->projection, "how distance is shown")
                 ->capture_default_str(),
             {"perspective", "orthographic"});
  command
      ->add_option("--azimuth", picture.camera.azimuth,
                   "where one looks from: degrees from the x axis towards the y axis")
      ->option_text("DEGREES")
      ->check(number_in(-360.0, 360.0))
      ->capture_default_str();
  command
      ->add_option("--elevation", picture.camera.elevation,
                   "degrees above the plane of x and y, from -90 to 90")
      ->option_text("DEGREES")
      ->check(number_in(-90.0, 90.0))
      ->capture_default_str();
  for (const auto& [name, size] :
       {std::pair{"--width", &picture.width}, {"--height", &picture.height}}) {
    command->add_option(name, *size, "size of the picture in pixels, from 300 to 8000")
        ->option_text("PIXELS")
        ->check(number_in(300, 8000))
        ->capture_default_str();
  }
  add_choice(command->add_option("--background", arguments->background, "colour of the ground")
                 ->capture_default_str(),
             {"dark", "light"});
  command->add_flag("--force", arguments->force, "replace existing files");
  command->footer(R"(Needles are drawn whole where they reach across a side of the periodic box,
with their centres inside. Far ones are thinner and closer to the ground.

Colours:
  speed, spin  speed and angular speed, as multiples of the root mean square
  vx, vy, vz   a component of the velocity, as a multiple of its root mean square
  alignment    3 cos^2 - 1 of the angle between needle and velocity
  density      centres in a ball around the centre that holds 30 others in the
               mean, as a multiple of that mean
  none         all needles alike

Examples:
  needlework view run.h5 -o needles.png
  needlework view run.h5 -o flow.svg --frame first --colour vx --background light)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_bench_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = app.add_subcommand(
      "bench", "measure searches, calendars and instruction sets on the same scenes");
  command
      ->add_option("SUBSET", arguments->subset,
                   "what to measure, by default quick; --list describes all")
      ->option_text(names_of_subsets());
  command->add_flag("--list", arguments->list, "list all subsets and their cases, measure nothing");
  command
      ->add_option("--repetitions", arguments->repetitions,
                   "how often all cases are measured in turn")
      ->option_text("N")
      ->check(number_in(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--min-time", arguments->min_time,
                   "least CPU time of a case in each repetition [s], from 0 to 3600")
      ->option_text("S")
      ->check(number_in(0.0, 3600.0))
      ->capture_default_str();
  command
      ->add_option(
          "--json", arguments->json_file,
          "print all that was measured as one JSON object; or print the table, and write to "
          "a file what --compare and --results need")
      ->expected(0, 1)
      ->option_text("[FILE.json]");
  command
      ->add_option("--compare", arguments->compare,
                   "older results, which --json has written to a file, to compare with")
      ->option_text("OLD.json");
  command
      ->add_option("--results", arguments->results,
                   "take the results from a file that --json has written, and measure nothing")
      ->option_text("FILE.json");
  command->add_flag("--quiet", arguments->quiet, "no progress");
  command->add_flag("--force", arguments->force, "replace an existing file");
  command->footer(filled(help_on_verdicts()));
  command->callback([arguments, command, &exit_code] {
    arguments->json = command->count("--json") > 0;
    exit_code = run(*arguments);
  });
}

// Runs use one process. Each process of an MPI job would do the same work and write the same file.
void require_one_process(const std::string& command) {
  const Launch launch = mpi_launch();
  if (launch.count <= 1 || command == "sweep") return;
  // A launcher ends the others as soon as one fails, so only the one with the message does.
  if (launch.rank > 0) throw CLI::RuntimeError(ok);
  print_error(fmt::format(
      "{}: started as {} processes by MPI: expected one: --threads N runs on several cores, and "
      "needlework sweep shares many runs among MPI processes",
      command, launch.count));
  throw CLI::RuntimeError(bad_usage);
}

OptionHelp help_of(const CLI::Option& option) {
  OptionHelp help;
  help.is_positional = option.get_positional();
  if (help.is_positional) {
    help.names = {option.get_name(true, false)};
  } else {
    for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
  }
  const bool takes_value = help.is_positional || option.get_items_expected_max() > 0;
  if (takes_value) help.value = option.get_option_text();
  if (help.is_positional && help.value.empty()) help.value = help.names[0];
  help.description = option.get_description();
  help.default_value = option.get_default_str();
  help.is_required = option.get_required();
  return help;
}

CommandHelp help_of_command(const CLI::App& app) {
  CommandHelp help{app.get_name(), app.get_description(), app.get_footer(), {}};
  for (const CLI::Option* option : app.get_options({})) help.options.push_back(help_of(*option));
  return help;
}

ProgramHelp help_of(const CLI::App& app) {
  ProgramHelp help{help_of_command(app), {}};
  for (const CLI::App* command : app.get_subcommands({})) {
    help.commands.push_back(help_of_command(*command));
  }
  return help;
}

// `needlework help COMMAND`, as other programs have it.
void add_help_command(CLI::App& app, int& exit_code) {
  CLI::App* help = app.add_subcommand("help", "show the arguments and options of a command");
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const auto name = std::make_shared<std::string>();
  help->add_option("COMMAND", *name, "one of the commands")
      ->option_text(fmt::format("{}", fmt::join(names, "|")));
  help->callback([&app, name, &exit_code] {
    const ProgramHelp program = help_of(app);
    if (!name->empty() && !program.find_command(*name)) {
      print_error(unknown_command_message(program, *name, {}) + " (see needlework --help)");
      exit_code = bad_usage;
      return;
    }
    const CLI::App* about = name->empty() ? &app : app.get_subcommand(*name);
    const std::string shown = name->empty() ? "needlework" : "needlework " + *name;
    fmt::print("{}", app.get_formatter()->make_help(about, shown, CLI::AppFormatMode::Normal));
  });
}

// Shows defaults beside descriptions, also where a text stands for the value.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return description_of(help_of(*option));
  }
};

void add_commands(CLI::App& app, int& exit_code) {
  const auto formatter = std::make_shared<HelpFormatter>();
  formatter->column_width(28);
  formatter->label("TEXT", "");
  formatter->label("REQUIRED", "(required)");
  app.formatter(formatter);
  app.set_help_flag("-h,--help", "show this help");
  app.require_subcommand(1);
  app.set_version_flag("-v,--version", version_text, "show version, compiler, CPU and libraries");
  add_run_command(app, exit_code);
  add_resume_command(app, exit_code);
  add_sweep_command(app, exit_code);
  add_reproduce_command(app, exit_code);
  add_check_command(app, exit_code);
  add_theory_command(app, exit_code);
  add_predict_command(app, exit_code);
  add_audit_command(app, exit_code);
  add_info_command(app, exit_code);
  add_import_command(app, exit_code);
  add_export_command(app, exit_code);
  add_report_command(app, exit_code);
  add_view_command(app, exit_code);
  add_serve_command(app, exit_code);
  add_bench_command(app, exit_code);
  add_help_command(app, exit_code);
  // Set last, because commands added later would inherit it.
  app.footer(R"(needlework COMMAND --help shows the arguments and options of a command.
Results are printed on standard output; progress, warnings and errors on
standard error.

Exit codes:
  0   done
  1   differences were found (audit, bench --compare)
  2   wrong usage
  3   a scene or an input file that cannot be used
  4   the state of a run became invalid
  5   a file that cannot be read or written
  75  stopped by a signal or a time limit, after saving if there is a file

Environment:
  NEEDLEWORK_ISA   instruction set, unless an option or the scene names one
  NO_COLOR         if set and not empty, run --watch draws without colours
  OMP_NUM_THREADS  number of threads, unless an option or the scene gives one)");
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app("event-driven simulation of gases of hard needles", "needlework");
  int exit_code = ok;
  add_commands(app, exit_code);
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  // Not an option of its own, as only the build needs it.
  if (arguments.size() == 2 && arguments[0] == "--print-reference") {
    fmt::print("{}", reference(help_of(app), arguments[1]));
    return ok;
  }
  app.parse_complete_callback(
      [&] { require_one_process(app.get_subcommands().front()->get_name()); });
  try {
    app.parse(argc, argv);
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help and --version
    print_error(usage_message(help_of(app), arguments, app.remaining(true), error.what()));
    return bad_usage;
  }
  return exit_code;
}

}  // namespace needlework::cli
