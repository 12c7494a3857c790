// The program: a client of the library.
#include <csignal>
#include <cstdio>
#include <exception>

#include "src/cli/command_line.h"
#include "src/cli/messages.h"
#include "src/cli/standard_streams.h"
#include "src/runs/exit_codes.h"
#include "src/runs/failure.h"

namespace needlework::cli {

using enum runs::ExitCode;
namespace {

int run_program(int argc, char** argv, bool can_print) {
  try {
    return run_command_line(argc, argv, can_print);
  } catch (const std::exception&) {
    const runs::Failure failure = runs::current_failure();
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
  // A file that reaches a limit of its size is a failed write, with a message, and not the end.
  std::signal(SIGXFSZ, SIG_IGN);
  const bool can_print = open_standard_streams();
  const int exit_code = run_program(argc, argv, can_print);
  if (exit_code == input_output_error || output_is_complete()) return exit_code;
  print_error("standard output: cannot be written");
  return input_output_error;
}
