// What is behind the opaque pointers and error structures of the C interface.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <string>

#include "needlework.h"
#include "src/runs/failure.h"
#include "src/runs/prepared_run.h"

struct needlework_simulation {
  needlework_simulation(needlework::runs::LoadedScene loaded, bool force)
      : run(std::move(loaded), force) {}

  needlework::runs::PreparedRun run;
  bool closed = false;
  std::string message, setting;
  std::atomic<bool> busy = false;  ///< whether a call or a callback uses the simulation
};

namespace needlework::c {

/// An argument or a call that is not allowed (NEEDLEWORK_USAGE).
struct UsageError : std::exception {
  explicit UsageError(std::string text) : message(std::move(text)) {}
  const char* what() const noexcept override { return message.c_str(); }
  std::string message;
};

/// Throws UsageError, "NAME is NULL: expected ...", if it is.
void require(const void* argument, const char* name);

/// The failure that the exception being handled stands for; to be called in a catch block.
runs::Failure failure_now();

/// Cuts the message off where the structure is full. `error` may be null.
void report(const runs::Failure& failure, needlework_error* error) noexcept;

/// Calls action(), and turns its exceptions into a code and a message. No exception leaves it, not
/// even one for want of memory.
template <class Action>
int guarded(needlework_error* error, Action&& action) noexcept {
  if (error) *error = {};
  try {
    action();
    return NEEDLEWORK_OK;
  } catch (...) {
    try {
      const runs::Failure failure = failure_now();
      report(failure, error);
      return failure.exit_code;
    } catch (...) {
      report({runs::bad_input, {}}, error);
      return NEEDLEWORK_INPUT;
    }
  }
}

/// The same with a simulation, which is claimed for the time of the call.
template <class Action>
int guarded(needlework_simulation* simulation, Action&& action) noexcept {
  if (!simulation || simulation->busy.exchange(true)) return NEEDLEWORK_USAGE;
  int code = NEEDLEWORK_OK;
  try {
    action(*simulation);
  } catch (...) {
    code = NEEDLEWORK_INPUT;
    try {
      runs::Failure failure = failure_now();
      code = failure.exit_code;
      simulation->message = std::move(failure.message);
    } catch (...) {
      simulation->message.clear();
    }
  }
  simulation->busy = false;
  return code;
}

}  // namespace needlework::c
