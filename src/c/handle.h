// What is behind the opaque pointers and error structures of the C interface.
#pragma once

#include <atomic>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "kernels/default_arithmetic.h"
#include "needlework.h"
#include "needlework/error.h"
#include "src/runs/prepared_run.h"

struct needlework_simulation {
  needlework_simulation(needlework::runs::LoadedScene loaded, bool force)
      : run(std::move(loaded), force) {}
  explicit needlework_simulation(needlework::runs::RunCheckpoint saved) : run(std::move(saved)) {}

  needlework::runs::PreparedRun run;
  bool closed = false;
  bool broken = false;  ///< whether a change of the state was cut off in the middle
  needlework_error last{};
  std::string setting;
  std::atomic<bool> busy = false;  ///< whether a call, or its callback, uses the simulation
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
/// Throws UsageError if there are flags that mean nothing.
void require_flags(unsigned flags);

/// Writes code and message of the exception being handled, and returns the code; to be called in a
/// catch block. `error` may be null. Needs no memory: a message for which there is none is
/// replaced.
int report_failure(needlework_error* error) noexcept;

/// Writes the code 0 and a warning. `error` may be null.
void report_warning(const std::string& warning, needlework_error* error) noexcept;

/// Calls action(), and turns its exceptions into a code and a message. No exception leaves it, not
/// even one for want of memory.
template <class Action>
int guarded(needlework_error* error, Action&& action) noexcept {
  const kernels::DefaultArithmetic arithmetic;
  if (error) *error = {};
  try {
    action();
    return NEEDLEWORK_OK;
  } catch (...) {
    return report_failure(error);
  }
}

/// Throws InvalidStateError if the simulation is broken.
void require_whole(const needlework_simulation& simulation);

/// The same with a simulation, which is claimed for the time of the call.
template <class Action>
int guarded(needlework_simulation* simulation, Action&& action) noexcept {
  if (!simulation || simulation->busy.exchange(true)) return NEEDLEWORK_USAGE;
  const kernels::DefaultArithmetic arithmetic;
  int code = NEEDLEWORK_OK;
  try {
    require_whole(*simulation);
    action(*simulation);
  } catch (...) {
    code = report_failure(&simulation->last);
  }
  simulation->busy = false;
  return code;
}

/// Changes the state of the simulation by change(). If memory does not suffice, or a defect of the
/// program is found, that ends in the middle of an event, and the simulation is broken.
template <class Change>
auto changing(needlework_simulation& simulation, Change&& change) {
  try {
    return change();
  } catch (const std::bad_alloc&) {
    simulation.broken = true;
    throw;
  } catch (const UnfinishedEventError&) {
    simulation.broken = true;
    throw;
  }
}

}  // namespace needlework::c
