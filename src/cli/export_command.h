// `needlework export`: needles as lines, for ParaView and VTK.
#pragma once

#include <CLI/App.hpp>

namespace needlework::cli {

/// Adds the subcommand `export FILE.h5 OUT.vtkhdf [--force]` to `app`. When it is chosen, parsing
/// runs it and sets `exit_code`, which must outlive `app`.
void add_export_command(CLI::App& app, int& exit_code);

}  // namespace needlework::cli
