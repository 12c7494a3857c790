// How a run ends, as the exit code of a program.
#pragma once

namespace needlework::runs {

enum ExitCode {
  ok = 0,
  differences_found = 1,
  bad_usage = 2,
  bad_input = 3,
  invalid_state = 4,
  input_output_error = 5,
  stopped = 75,  ///< by a signal or a time limit, after saving if there is a file
};

}  // namespace needlework::runs
