#include "src/c/handle.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace needlework::c {

void require(const void* argument, const char* name) {
  if (!argument) throw UsageError(std::string(name) + " is NULL: expected a pointer");
}

runs::Failure failure_now() {
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

void report(const runs::Failure& failure, needlework_error* error) noexcept {
  if (!error) return;
  error->code = failure.exit_code;
  const std::size_t length = std::min(failure.message.size(), sizeof(error->message) - 1);
  std::memcpy(error->message, failure.message.data(), length);
  error->message[length] = 0;
}

}  // namespace needlework::c
