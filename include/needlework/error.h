// The errors that a client can meet. Each carries a message meant for a person; the program maps
// them to its exit codes.
#pragma once

#include <stdexcept>
#include <string>

namespace needlework {

/// A scene or an input file that cannot be used (exit code 3). The message names the place, the
/// value and what was expected: "FILE: line N: section.key = VALUE: expected ...".
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A simulation that cannot be continued correctly, such as an unresolvable collapse (exit code 4).
struct InvalidStateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written (exit code 5).
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace needlework
