// The commands of the program and their options.
#pragma once

namespace needlework::cli {

/// Parses the command line and runs the command that it names; returns its exit code. What is wrong
/// with the command line itself is printed on stderr. `can_print`: whether standard output is open;
/// else commands whose result it is are refused. Throws what the command throws.
int run_command_line(int argc, char** argv, bool can_print);

}  // namespace needlework::cli
