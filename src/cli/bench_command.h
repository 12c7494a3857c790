// `needlework bench`: measures named subsets of scenes, and compares results.
#pragma once

#include <CLI/App.hpp>

namespace needlework::cli {

/// Adds the subcommand; when it has run, its exit code is in `exit_code`.
void add_bench_command(CLI::App& app, int& exit_code);

}  // namespace needlework::cli
