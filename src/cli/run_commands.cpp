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
  add_force(*command, arguments->force);
  command->footer(R"(Writes a file only where --out or output.file of the scene names one.
docs/json.md describes what --json prints and --log writes.

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
                   "replace an end of the run, as in until.time=100, or remove it by "
                   "until.time=none; repeatable")
      ->option_text("until.KEY=VALUE")
      ->allow_extra_args(false);
  add_engine_options(*command, arguments->engine);
  add_printing(*command, arguments->printing);
  command->footer(R"(The run continues from its last checkpoint, FILE.h5.checkpoint, with the same
collisions as if it had never been stopped. Its ends count from its start, except
wall_s, which counts from now.

Examples:
  needlework resume cooling.h5
  needlework resume cooling.h5 --set until.time=1e6 --threads 2)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_replay_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("replay", "repeat the failure of a run");
  const auto arguments = std::make_shared<ReplayArguments>();
  command
      ->add_option("BUNDLE", arguments->bundle,
                   "file that the failed run has named, or a checkpoint")
      ->required()
      ->option_text("FILE");
  command->add_option("--last", arguments->last, "number of last collisions to print")
      ->option_text("N")
      ->check(number_in(0, 1000000))
      ->capture_default_str();
  add_engine_options(*command, arguments->engine);
  add_json(*command, arguments->json);
  add_quiet(*command, arguments->quiet);
  add_progress_every(*command, arguments->progress_every);
  command->footer(R"(A run with an output file FILE.h5 that fails with exit code 4 leaves a bundle,
FILE.h5.failure. The run is repeated from its last checkpoint, without output,
until it fails again or passes that place, and the last collisions of the needles
that the failure is about, or of all, are printed.

Exit codes: 4 if the run fails again in the same way, else 1.

Example:
  needlework replay cooling.h5.failure)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_sweep_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("sweep", "run a scene for a grid of parameters and seeds");
  const auto arguments = std::make_shared<SweepArguments>();
  command->add_option("GRID.toml", arguments->grid, "grid file")->required();
  command->add_option("--out", arguments->out, "folder for the results (default: out of the grid)")
      ->option_text("DIR");
  command
      ->add_option("--threads", arguments->threads,
                   "number of members that run at a time (default: the number of cores)")
      ->option_text("N")
      ->check(number_in(1, 1024));
  add_isa(*command, arguments->isa);
  command->add_option("--member", arguments->member, "run only part K of M")->option_text("K/M");
  command->add_flag("--summary", arguments->summary,
                    "run nothing, sum up the members that are finished");
  CLI::Option* json = add_json(*command, arguments->json);
  command
      ->add_flag(
          "--csv", arguments->csv,
          "print the results at the ends of the runs, a line for each point; not with --json")
      ->excludes(json);
  add_quiet(*command, arguments->quiet);
  add_progress_every(*command, arguments->progress_every);
  add_log(*command, arguments->log);
  command->add_flag(
      "--force", arguments->force,
      "continue in the folder of another grid, where members that differ are run again");
  command->footer(
      R"(A member is one run: a point of the grid with one of the seeds. The same command
continues a sweep that was stopped. docs/sweeps.md describes grids and results.

Examples:
  needlework sweep profiles/sweep-cooling.toml --out cooling-sweep
  needlework sweep grid.toml --out results --member 3/16)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_reproduce_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("reproduce", "make the figures of the paper and check its claims");
  const auto arguments = std::make_shared<ReproduceArguments>();
  command->add_option("FIGURE", arguments->figure, "all, or one of those listed below")
      ->required()
      ->check(one_of(names_of_figures()));
  CLI::Option* const quick =
      command->add_flag("--quick", arguments->quick,
                        "smaller systems, fewer seeds: some 10 minutes of processor time for all");
  command
      ->add_option("--out", arguments->out,
                   "folder for runs, data and pictures (default: reproduction, or "
                   "reproduction-quick)")
      ->option_text("DIR");
  CLI::Option* const threads =
      command
          ->add_option("--threads", arguments->threads,
                       "number of runs at a time (default: the number of cores)")
          ->option_text("N")
          ->check(number_in(1, 1024));
  CLI::Option* const json = add_json(*command, arguments->json);
  add_quiet(*command, arguments->quiet);
  CLI::Option* const force =
      command->add_flag("--force", arguments->force,
                        "use a folder that holds something else; runs that differ are run again");
  command
      ->add_option("--from", arguments->data,
                   "run nothing, and draw the pictures again from the data (CSV) in a folder, into "
                   "--out or the same one; not with --quick, --threads, --json, --force")
      ->option_text("DIR")
      ->excludes(quick)
      ->excludes(threads)
      ->excludes(json)
      ->excludes(force);
  command->footer(help_on_figures() +
                  R"(
The paper is "Granular cooling of hard needles" by Huthmann, Aspelmeier and
Zippelius. Writes data (CSV) and a picture (SVG) of each figure, and compares
each claim with the measurement: it agrees if the whole 99 % confidence interval
of the mean over seeds lies within the precision that is stated, differs if it
lies outside as a whole, and is open otherwise. The same command continues after
an interruption.

Needs Python with NumPy, h5py and Matplotlib: that of the build, or the one that
NEEDLEWORK_PYTHON names.

Examples:
  needlework reproduce 3 --quick
  needlework reproduce all --out reproduction
  needlework reproduce 5a --from reproduction --out pictures)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_check_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("check", "explain a scene and estimate its time and memory");
  const auto arguments = std::make_shared<CheckArguments>();
  add_scene_arguments(*command, arguments->scene);
  add_json(*command, arguments->json);
  command->footer(
      R"(What it expects of the run follows from kinetic theory. Where some needles are
fixed, energies and mean free times are of those that move, and collisions per
needle of all. docs/json.md describes what --json prints.

Example:
  needlework check profiles/quickstart.toml)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_theory_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<TheoryArguments>();
  CLI::App* command = app.add_subcommand("theory", "print what kinetic theory predicts");
  add_scene(*command, arguments->scene, arguments->overrides, false);
  command->add_option("--epsilon", arguments->epsilon, "normal restitution, from 0 to 1")
      ->option_text("E");
  command
      ->add_option("--k", arguments->k,
                   "m L^2 / (2 I): 6 for a uniform rod, 2 for all mass at the tips")
      ->option_text("K");
  command
      ->add_option("--q", arguments->q,
                   "4 I / (m D^2) of rough spheres, in place of --k: 0.4 if homogeneous, 2/3 for "
                   "all mass at the surface")
      ->option_text("Q");
  command
      ->add_option("--beta", arguments->beta,
                   "tangential restitution, from -1 (smooth, the default) to 1")
      ->option_text("B");
  command
      ->add_option("--t-rot0", arguments->t_rot0,
                   "initial T_rot (default: 1); without a scene, T_tr is 1")
      ->option_text("X");
  command
      ->add_option("--tau", arguments->taus,
                   "print the temperatures at this scaled time; repeatable")
      ->option_text("T")
      ->allow_extra_args(true);
  command
      ->add_option("--time", arguments->times,
                   "print them at this time; needs a density; repeatable")
      ->option_text("T");
  command->add_option("--density", arguments->density, "needles per unit of volume")
      ->option_text("N");
  command
      ->add_option("--boltzmann", arguments->boltzmann,
                   "simulate the Boltzmann equation: a pair collides once, or until it has parted "
                   "for good")
      ->option_text("single|encounters")
      ->check(one_of({"single", "encounters"}));
  command
      ->add_option("--needles", arguments->needles,
                   "number of needles of --boltzmann (default: 32000)")
      ->option_text("N");
  command->add_option("--seed", arguments->seed, "seed of --boltzmann (default: 1)")
      ->option_text("S");
  command
      ->add_option("--tc", arguments->tc,
                   "contact time of encounters, in L (m / T_tr)^1/2 (default: 1e-3)")
      ->option_text("X");
  add_json(*command, arguments->json);
  command->footer(R"(Of a homogeneous gas. What no option gives is taken from the scene. Without a
scene, --epsilon and --k are needed, or --epsilon, --beta and --q of rough
spheres at low density, of diameter 1.

tau = (2/3) sqrt(pi) n sqrt(T_tr(0)) t is the time t scaled by the density n and
the initial T_tr. c is the ratio T_tr / T_rot that a gas tends to as it cools,
and k_star the k at which c = 1 for every epsilon (smooth needles).

Only --time, --set, --json and the options of --boltzmann go with a scene of
several species.

--boltzmann prints means with errors, at times in ascending order. Velocities
need not stay Gaussian, and with encounters pairs may collide again. Rods of
finite width are refused.

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
                              "level of accuracy; the next four options depart from it")
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
                   "engine.root_tolerance of a scene, from 0 to 1e-3")
      ->option_text("X")
      ->check(number_in(0.0, 1e-3));
  command
      ->add_option("--sampling-step", engine.sampling_step,
                   "engine.sampling_step of a scene, from 1e-4 to 0.5")
      ->option_text("X")
      ->check(number_in(1e-4, 0.5));
  add_json(*command, arguments->json);
  command->footer(R"(A line of PAIRS.csv is id,family,horizon, then x,y,z of r1,u1,v1,w1,r2,u2,v2,w2
(centre, director, velocity, angular velocity), then skip: 1 if the pair has just
collided, else 0. Lengths and diameters La,Lb,Da,Db may follow. Lines that begin
with # are comments.

Prints id,time,s12,s21 of each pair: the time and the arms of the contact, or inf
and nan if there is none in (0, horizon]. A search of more than about a second is
an error, as is a time too late for the precision of a double.

Example:
  needlework predict pairs.csv --accuracy rigorous --json)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_audit_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("audit", "run a scene and check its collisions independently");
  const auto arguments = std::make_shared<AuditArguments>();
  add_scene_arguments(*command, arguments->scene);
  command
      ->add_option("--share", arguments->share,
                   "share of all pairs to check, above 0, drawn at random")
      ->option_text("P")
      ->check(number_in(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "seed by which these pairs are drawn")
      ->option_text("N")
      ->check(number_in(0.0, 0x1p64))
      ->capture_default_str();
  command->add_option("--state", arguments->state, "file from which an interrupted audit continues")
      ->option_text("FILE");
  add_json(*command, arguments->json);
  add_quiet(*command, arguments->quiet);
  command->footer(R"(Follows every pair with physics of its own. Exit code 1: there are differences,
of which docs/audit.md lists the kinds.

Example:
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
