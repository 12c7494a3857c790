// Collisions, and all that happens, as rows of a structured NumPy array.
#pragma once

#include <pybind11/numpy.h>

#include <span>

#include "needlework/happening.h"

namespace needlework::python {

/// A new array with one row for each of them. The type of rows is one of those that
/// python/needlework/collisions.py defines, with or without the states after the event.
/// Throws InputError for a type of another size.
pybind11::array rows_of(std::span<const Collision> collisions, const pybind11::dtype& type);
pybind11::array rows_of(std::span<const Happening> happenings, const pybind11::dtype& type);

}  // namespace needlework::python
