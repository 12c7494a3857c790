// Errors of the library as Python exceptions.
#pragma once

#include <pybind11/pybind11.h>

#include <stdexcept>

namespace needlework::python {

/// A simulation that is used while it runs, or after it was closed.
struct UseError : std::logic_error {
  using std::logic_error::logic_error;
};

/// From now on, the library's errors leave the functions of this module as the exceptions of
/// needlework.errors, with their messages.
void translate_errors();

}  // namespace needlework::python
