// `needlework predict`: the first contact of each pair in a file.
#pragma once

namespace CLI {
class App;
}

namespace needlework {

/// Adds the subcommand `predict PAIRS.csv [--accuracy LEVEL] [--json]` to `app`. When it is chosen,
/// parsing runs it: answers go to stdout, errors to stderr, and `exit_code` becomes 0, 3 for a
/// line, level or pair that cannot be used, or 5 for a file that cannot be read or written. `app`
/// keeps a reference to `exit_code`. Nothing is printed to stdout when any line is bad.
void add_predict_command(CLI::App& app, int& exit_code);

}  // namespace needlework
