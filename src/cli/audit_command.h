// `needlework audit`.
#pragma once

#include <CLI/CLI.hpp>

namespace needlework::cli {

/// Adds the subcommand; when it has run, its exit code is in `exit_code`.
void add_audit_command(CLI::App& app, int& exit_code);

}  // namespace needlework::cli
