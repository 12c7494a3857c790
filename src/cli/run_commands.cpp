#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "src/cli/audit_command.h"
#include "src/cli/check_command.h"
#include "src/cli/commands.h"
#include "src/cli/options.h"
#include "src/cli/predict_command.h"
#include "src/cli/replay_command.h"
#include "src/cli/reproduce_command.h"
#include "src/cli/resume_command.h"
#include "src/cli/run_command.h"
#include "src/cli/sweep_command.h"
#include "src/cli/theory_command.h"

namespace needlework::cli {
namespace {

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
scene, no file is written. --watch needs a terminal. docs/log.md describes the
lines of --log.

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
                   "replace an end of the run, such as until.time=100, or remove it by "
                   "until.time=none; may be repeated")
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

void add_replay_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("replay", "show again how a run has failed");
  const auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("BUNDLE", arguments->bundle, "file that the failed run has named")
      ->required()
      ->option_text("FILE");
  command
      ->add_option("--last", arguments->last, "number of collisions to print, the last of the run")
      ->option_text("N")
      ->check(number_in(0, 1000000))
      ->capture_default_str();
  add_engine_options(*command, arguments->engine);
  command->add_flag("--json", arguments->json, "print the result as one JSON object");
  command->add_flag("--quiet", arguments->quiet, "no progress, no result");
  add_progress_every(*command, arguments->progress_every);
  command->footer(R"(A run with an output file FILE.h5 that fails with exit code 4 leaves a bundle,
FILE.h5.failure: its last checkpoint before the failure, and what the failure
was. The run is repeated from there, without output, until it fails or passes
the place where it failed. Printed are the last collisions of the needles that
the failure is about, or of all needles. A checkpoint is taken, too: that of a
run whose process has crashed, for instance.

Exit codes: 4 if the run fails again in the same way, 1 if it does not, or in
another way.

Example:
  needlework replay cooling.h5.failure)");
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
  CLI::Option* json =
      command->add_flag("--json", arguments->json, "print the result as one JSON object");
  command
      ->add_flag("--csv", arguments->csv,
                 "print the means and errors at the ends of the runs, a line for each point")
      ->excludes(json);
  command->add_flag("--quiet", arguments->quiet, "no progress, no table");
  add_progress_every(*command, arguments->progress_every);
  add_log(*command, arguments->log);
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
  CLI::Option* const quick =
      command->add_flag("--quick", arguments->quick,
                        "smaller systems, fewer seeds: some 10 minutes of processor time");
  command
      ->add_option("--out", arguments->out,
                   "folder for runs, data and pictures; by default reproduction, or "
                   "reproduction-quick")
      ->option_text("DIR");
  CLI::Option* const threads =
      command
          ->add_option("--threads", arguments->threads,
                       "number of runs at a time; by default, the number of cores")
          ->option_text("N")
          ->check(number_in(1, 1024));
  CLI::Option* const json =
      command->add_flag("--json", arguments->json, "print the claims as one JSON object");
  command->add_flag("--quiet", arguments->quiet, "no progress, no table");
  CLI::Option* const force =
      command->add_flag("--force", arguments->force,
                        "use a folder with something else in it; runs that differ are run again");
  command
      ->add_option("--from", arguments->data,
                   "run nothing, and draw the pictures again from the data (CSV) in a folder; "
                   "by default into the same one")
      ->option_text("DIR")
      ->excludes(quick)
      ->excludes(threads)
      ->excludes(json)
      ->excludes(force);
  command->footer(R"(The paper is "Granular cooling of hard needles" by Huthmann, Aspelmeier and
Zippelius. Runs that are finished are used again; the same command continues
after an interruption. For each figure, its data (CSV) and picture (SVG) are
written, and each claim is compared with the measurement: it agrees if the whole
99 % confidence interval of the mean over seeds lies within the precision that
is stated, differs if it lies outside as a whole, and is open otherwise. The
last figures go beyond the paper: why theory is off, gases that are kicked,
shaken, confined or fall, rods of finite width, and the liquid of needles.

The runs are sweeps of this program, and simulations of the Boltzmann equation
by theory. Data, pictures and verdicts are made by the
Python package needlework.reproduce, which needs NumPy, h5py and Matplotlib; the
environment variable NEEDLEWORK_PYTHON names a Python other than the one that
the package was built for.

Examples:
  needlework reproduce 3 --quick
  needlework reproduce all --out reproduction
  needlework reproduce 5a --from reproduction --out pictures)");
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
  command
      ->add_option("--boltzmann", arguments->boltzmann,
                   "simulate the Boltzmann equation: each pair collides once, or until it has "
                   "parted for good")
      ->option_text("single|encounters")
      ->check(one_of({"single", "encounters"}));
  command->add_option("--needles", arguments->needles, "number of needles in it (default: 32000)")
      ->option_text("N");
  command
      ->add_option("--seed", arguments->seed, "of its random numbers; by default the scene's, or 1")
      ->option_text("S");
  command
      ->add_option("--tc", arguments->tc,
                   "contact time in encounters, in L (m / T_tr)^1/2; by default the scene's, or "
                   "1e-3")
      ->option_text("X");
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(R"(Takes epsilon, k, beta, the density and the initial temperatures from the
scene, if one is given; options come first. Without a scene, --epsilon and
--k are needed.

tau = (2/3) sqrt(pi) n sqrt(T_tr(0)) t is the time t scaled by the density n
and the initial T_tr, so that the cooling curve is the same for all. c is the ratio T_tr / T_rot that
a gas tends to as it cools, and k_star the k at which c = 1 for every epsilon
(smooth needles).

Of a scene of several species it prints how often each two of them collide at
the start, how fast their temperatures change, and the temperatures of each.
Of the options only --time, --set, --json and those of --boltzmann go with
such a scene.

--boltzmann gives what kinetic theory leaves out, with errors, in the limit of
low density: velocities that do not stay Gaussian, and, with encounters, pairs
that collide again. Times are in ascending order then. Scenes may have several
species of thin needles, of which it gives the means of each and the collisions
of each two; rods of finite width are refused.

Examples:
  needlework theory profiles/quickstart.toml
  needlework theory --epsilon 0.8 --k 6 --tau 10 --boltzmann encounters
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
v2,w2, then skip: 1 if the pair has just collided at time 0, else 0. La,Lb,Da,Db
may follow: lengths, and diameters of rods of finite width or 0. Lines that
begin with # are comments. For each pair the output has id,time,s12,s21, with
time inf if there is no contact in (0, horizon]. A search of more than about
a second is an error, as for needles that turn near each other for hundreds of
thousands of radians without a contact; so is a time so late that a double
cannot tell where the needles are.

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

}  // namespace

void add_run_commands(CLI::App& app, int& exit_code) {
  add_run_command(app, exit_code);
  add_resume_command(app, exit_code);
  add_replay_command(app, exit_code);
  add_sweep_command(app, exit_code);
  add_reproduce_command(app, exit_code);
  add_check_command(app, exit_code);
  add_theory_command(app, exit_code);
  add_predict_command(app, exit_code);
  add_audit_command(app, exit_code);
}

}  // namespace needlework::cli
