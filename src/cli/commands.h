// The commands of the program, in groups, each in a file of its own.
#pragma once

#include <CLI/CLI.hpp>

namespace needlework::cli {

/// Commands about runs: run, resume, replay, sweep, reproduce, check, theory, predict, audit. The
/// command that is called sets the exit code.
void add_run_commands(CLI::App& app, int& exit_code);
/// Commands about files: info, import, export, report, view.
void add_file_commands(CLI::App& app, int& exit_code);

}  // namespace needlework::cli
