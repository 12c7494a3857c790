#include "src/runs/failure.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "needlework/error.h"
#include "src/machine/stop_request.h"

namespace needlework::runs {
namespace {

constexpr const char* not_enough_memory =
    "not enough memory: expected fewer needles (needles.count)";

}  // namespace

Failure current_failure() {
  try {
    throw;
  } catch (const InputError& error) {
    return {bad_input, error.what()};
  } catch (const InvalidStateError& error) {
    return {invalid_state, error.what()};
  } catch (const IoError& error) {
    return {input_output_error, error.what()};
  } catch (const StoppedEarly& stop) {
    return {stopped, stop.what()};
  } catch (const std::bad_alloc&) {
    return {bad_input, not_enough_memory};
  } catch (const std::length_error&) {  // more than any memory
    return {bad_input, not_enough_memory};
  } catch (const std::system_error& error) {  // of printing
    return {input_output_error, error.what()};
  } catch (const std::exception& error) {
    return {invalid_state, fmt::format("unexpected error: {}", error.what())};
  }
}

}  // namespace needlework::runs
