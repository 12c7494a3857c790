#include "src/c/handle.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "needlework/error.h"
#include "src/runs/failure.h"

namespace needlework::c {
namespace {

runs::Failure current_failure() {
  try {
    throw;
  } catch (const UsageError& error) {
    return {runs::bad_usage, error.what()};
  } catch (const std::invalid_argument& error) {  // of the theory
    return {runs::bad_usage, error.what()};
  } catch (...) {
    return runs::current_failure();
  }
}

/// Cuts the message off where the structure is full, but not within a character of UTF-8.
void put(int code, std::string_view message, needlework_error* error) noexcept {
  if (!error) return;
  std::size_t length = message.size();
  if (length >= sizeof error->message) {
    length = sizeof error->message - 1;
    while (length > 0 && (message[length] & 0xC0) == 0x80) --length;
  }
  error->code = code;
  std::memcpy(error->message, message.data(), length);
  error->message[length] = 0;
}

}  // namespace

void require(const void* argument, const char* name) {
  if (!argument) throw UsageError(std::string(name) + " is NULL: expected a pointer");
}

void require_flags(unsigned flags) {
  if ((flags & ~unsigned{NEEDLEWORK_REPLACE}) == 0) return;
  throw UsageError("flags = " + std::to_string(flags) + ": expected 0 or NEEDLEWORK_REPLACE");
}

void require_whole(const needlework_simulation& simulation) {
  if (!simulation.broken) return;
  throw InvalidStateError(
      "an error came in the middle of an event: expected the simulation to be destroyed");
}

int report_failure(needlework_error* error) noexcept {
  try {
    const runs::Failure failure = current_failure();
    put(failure.exit_code, failure.message, error);
    return failure.exit_code;
  } catch (...) {
    put(NEEDLEWORK_INPUT, "not enough memory", error);
    return NEEDLEWORK_INPUT;
  }
}

void report_warning(const std::string& warning, needlework_error* error) noexcept {
  put(NEEDLEWORK_OK, warning, error);
}

}  // namespace needlework::c
