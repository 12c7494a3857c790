// The errors that a client can meet. Each carries a message meant for a person; the program maps
// them to its exit codes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
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
  /// Ids of two needles, equal if there is one.
  using Needles = std::optional<std::array<std::uint32_t, 2>>;
  explicit InvalidStateError(const std::string& message, const Needles& which = {})
      : std::runtime_error(message), needles(which) {}

  Needles needles;  ///< those that the error is about, if it is about some
};

/// The same in the middle of an event. The state of the simulation is neither that before the event
/// nor that after it, so that it must be neither continued nor saved.
struct UnfinishedEventError : InvalidStateError {
  using InvalidStateError::InvalidStateError;
};

/// A file that cannot be read or written (exit code 5).
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace needlework
