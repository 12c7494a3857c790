// Collisions as rows of a structured NumPy array.
#pragma once

#include <pybind11/numpy.h>

#include <span>

#include "needlework/collision.h"

namespace needlework::python {

/// A new array with one row for each collision. The type of rows is one of those that
/// python/needlework/collisions.py defines, with or without the states after the collision.
/// Throws InputError for a type of another size.
pybind11::array collision_rows(std::span<const Collision> collisions, const pybind11::dtype& type);

}  // namespace needlework::python
