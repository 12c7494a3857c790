// `needlework sweep`: a grid of parameters and seeds, and what its runs have in common.
#pragma once

#include <CLI/App.hpp>

namespace needlework::cli {

/// Adds the subcommand; when it has run, its exit code is in `exit_code`.
void add_sweep_command(CLI::App& app, int& exit_code);

}  // namespace needlework::cli
