#include "src/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "needlework/error.h"
#include "src/cli/bench_command.h"
#include "src/cli/commands.h"
#include "src/cli/messages.h"
#include "src/cli/options.h"
#include "src/cli/ranks.h"
#include "src/cli/reference.h"
#include "src/cli/usage.h"
#include "src/cli/version.h"
#include "src/runs/exit_codes.h"
#include "src/serve/server.h"

namespace needlework::cli {

using enum runs::ExitCode;

namespace {

void add_serve_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("serve", "simulate for a front end over a pipe");
  command->footer(R"(Reads requests from standard input and answers on standard output, both as one
JSON object a line, until quit or the end of the input. docs/serve.md describes
the requests.

Example:
  echo '{"do": "create", "path": "profiles/quickstart.toml"}' | needlework serve)");
  command->callback([&exit_code] {
    // A front end that has gone is a failed write, with a message, and not the end.
    std::signal(SIGPIPE, SIG_IGN);
    serve::serve(std::cin, std::cout);
    exit_code = ok;
  });
}

// A scene in place of a subset, and what is to be compared on it.
void add_own_scene(CLI::App& command, CLI::Option& subset, bench::OwnScene& own) {
  CLI::Option* scene =
      command.add_option("--scene", own.file, "measure this scene in place of SUBSET")
          ->option_text("SCENE.toml")
          ->excludes(&subset);
  command.add_option("--set", own.overrides, "replace a key of that scene; repeatable")
      ->option_text("SECTION.KEY=VALUE")
      ->allow_extra_args(false)
      ->needs(scene);
  const auto add_list = [&](const char* name, std::vector<std::string>& values, const char* what,
                            const char* example) {
    command.add_option(name, values, what)
        ->option_text(example)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->needs(scene);
  };
  add_list(
      "--searches", own.searches,
      "values of engine.search to compare with the scene as it is, the baseline; where nothing "
      "is to be compared, linked-cells and capsules",
      "NAME,...");
  add_list("--queues", own.calendars, "values of engine.queue to compare", "NAME,...");
  add_list("--accuracy", own.accuracies, "values of engine.accuracy to compare", "LEVEL,...");
  add_list("--isa", own.isas, "values of engine.isa to compare", "NAME,...");
  add_list("--threads", own.threads,
           "values of engine.threads to compare, by wall time instead of CPU time", "N,...");
  add_list("--cell-sides", own.cell_sides, "values of engine.cell_side to compare", "LENGTH,...");
  add_list("--capsule-radii", own.capsule_radii, "values of engine.capsule_radius to compare",
           "LENGTH,...");
  command.add_option("--vary", own.settings, "compare with this value of any key; repeatable")
      ->option_text("SECTION.KEY=VALUE")
      ->allow_extra_args(false)
      ->needs(scene);
}

void add_bench_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = app.add_subcommand("bench", "measure the speed of searches, queues and more");
  CLI::Option* subset =
      command
          ->add_option("SUBSET", arguments->subset,
                       "what to measure: one of the names that --list prints with their "
                       "cases")
          ->type_name(names_of_subsets())
          ->capture_default_str();
  command->add_flag("--list", arguments->list, "list the names of SUBSET, measure nothing");
  add_own_scene(*command, *subset, arguments->own);
  command
      ->add_option("--repetitions", arguments->repetitions,
                   "how often all cases are measured in turn; from 6 on with intervals of 95 %")
      ->option_text("N")
      ->check(number_in(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--min-time", arguments->min_time,
                   "least CPU time of a case in each repetition [s]")
      ->option_text("S")
      ->check(number_in(0.0, 3600.0))
      ->capture_default_str();
  command
      ->add_option(
          "--json", arguments->json_file,
          "print the measurements as one JSON object, or write them to a file for --compare and "
          "--results, and print the table")
      ->expected(0, 1)
      ->option_text("[FILE.json]");
  command->add_option("--csv", arguments->csv_file, "write a table with a line for each case")
      ->option_text("FILE.csv");
  command
      ->add_option("--compare", arguments->compare,
                   "compare with older results, a file that --json has written")
      ->option_text("OLD.json");
  command
      ->add_option("--results", arguments->results,
                   "measure nothing, take results from a file that --json has written")
      ->option_text("FILE.json");
  command->add_flag("--quiet", arguments->quiet, "no progress");
  add_force(*command, arguments->force);
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

// Whether all would be in vain without standard output. Other commands write files, and their
// summaries may be lost.
bool prints_its_result(const CLI::App& command) {
  constexpr std::array names{"bench", "check", "help", "info", "predict", "serve", "theory"};
  if (std::find(names.begin(), names.end(), command.get_name()) != names.end()) return true;
  const CLI::Option* json = command.get_option_no_throw("--json");
  return json && json->count() > 0;
}

[[noreturn]] void fail_to_print() {
  throw IoError(
      "standard output: is closed: expected it to be open, as the result is printed there");
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
  // The description of one_of(), or a type that names all values.
  const std::string type = option.get_type_name(), words = type.substr(type.rfind(':') + 1);
  if (words.find('|') != words.npos) {
    std::istringstream list(words);
    for (std::string word; std::getline(list, word, '|');) help.choices.push_back(word);
  }
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
      ->type_name(fmt::format("{}", fmt::join(names, "|")));
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

// Shows defaults beside descriptions, in lines of at most 78 characters. What the parser would add
// to names, such as the options that exclude each other, is in the descriptions.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string& text = option->get_option_text();
    return text.empty() ? "" : " " + text;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return filled(description_of(help_of(*option)), 78 - column_width_);
  }
};

void add_commands(CLI::App& app, int& exit_code) {
  const auto formatter = std::make_shared<HelpFormatter>();
  formatter->column_width(28);
  formatter->label("SUBCOMMAND", "COMMAND");
  formatter->label("Positionals", "Arguments");
  formatter->label("POSITIONALS", "Arguments");  // the parser's later versions
  app.formatter(formatter);
  app.set_help_flag("-h,--help", "show this help");
  app.require_subcommand(1);
  app.set_version_flag("-v,--version", version_text, "show version, compiler, CPU and libraries");
  add_run_commands(app, exit_code);
  add_file_commands(app, exit_code);
  add_serve_command(app, exit_code);
  add_bench_command(app, exit_code);
  add_help_command(app, exit_code);
  for (CLI::App* command : app.get_subcommands({})) command->group("Commands");
  // Set last, because commands added later would inherit it.
  app.footer(
      R"(needlework COMMAND --help shows its arguments and options. Results go to
standard output; progress, warnings and errors to standard error.

Exit codes:
  0   done
  1   differences found (audit, bench --compare, replay)
  2   wrong usage
  3   a scene or input file that cannot be used
  4   a run cannot go on: needles collapse, a limit of long runs, a defect
  5   a file that cannot be read or written, or a missing package (reproduce)
  75  stopped by a signal or a time limit, after saving if there is a file

Environment:
  HDF5_USE_FILE_LOCKING
                   FALSE: files are not locked, so that two writers go unnoticed
  NEEDLEWORK_FORK  0: HDF5 files are read without a child process
  NEEDLEWORK_ISA   instruction set, unless an option or the scene names one
  NEEDLEWORK_PYTHON
                   Python that reproduce calls, in place of the one of the build
  NO_COLOR         if set and not empty, run --watch draws without colours
  OMP_NUM_THREADS  number of threads, unless an option or the scene gives one)");
}

}  // namespace

int run_command_line(int argc, char** argv, bool can_print) {
  CLI::App app("event-driven simulation of gases of hard needles", "needlework");
  int exit_code = ok;
  add_commands(app, exit_code);
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  // Not an option of its own, as only the build needs it.
  if (arguments.size() == 2 && arguments[0] == "--print-reference") {
    fmt::print("{}", reference(help_of(app), arguments[1]));
    return ok;
  }
  app.parse_complete_callback([&] {
    const CLI::App& command = *app.get_subcommands().front();
    require_one_process(command.get_name());
    if (!can_print && prints_its_result(command)) fail_to_print();
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help and --version
      if (!can_print) fail_to_print();
      return app.exit(error);
    }
    print_error(usage_message(help_of(app), arguments, app.remaining(true), error.what()));
    return bad_usage;
  }
  return exit_code;
}

}  // namespace needlework::cli
