// `needlework predict`: the first contact of each pair in a file.
#pragma once

namespace CLI {
class App;
}

namespace needlework::cli {

/// Adds the subcommand `predict PAIRS.csv [--accuracy LEVEL] [--json]` to `app`. When it is chosen,
/// parsing runs it: answers go to stdout, and `exit_code`, to which `app` keeps a reference,
/// becomes 0. Throws InputError for a line, level or pair that cannot be used, IoError for a file
/// that cannot be read; then nothing is printed.
void add_predict_command(CLI::App& app, int& exit_code);

}  // namespace needlework::cli
