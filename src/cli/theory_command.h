// The command `needlework theory`: what kinetic theory predicts for a gas.
#pragma once

#include <CLI/App.hpp>

namespace needlework::cli {

/// Registers the subcommand with `app`. When it is given, parsing ends by printing the predictions
/// on stdout and setting `exit_code` to 0, or by printing one line on stderr that names flag, value
/// and expectation and setting it to 2. `exit_code` must outlive `app`.
void add_theory_command(CLI::App& app, int& exit_code);

}  // namespace needlework::cli
