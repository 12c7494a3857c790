// The program: a client of the library.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

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
#include "src/runs/failure.h"

namespace needlework::cli {
namespace {

int parse_and_run(int argc, char** argv) {
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

int run_program(int argc, char** argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (const std::exception&) {
    const Failure failure = current_failure();
    print_error(failure.message);
    return failure.exit_code;
  }
}

// What is not printed completely, to a full disk say, is no result.
bool output_is_complete() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace
}  // namespace needlework::cli

int main(int argc, char** argv) {
  using namespace needlework::cli;
  const int exit_code = run_program(argc, argv);
  if (output_is_complete()) return exit_code;
  print_error("standard output: cannot be written");
  return input_output_error;
}
