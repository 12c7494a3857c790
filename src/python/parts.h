// The parts of the module, which module.cpp puts together.
#pragma once

#include <pybind11/pybind11.h>

namespace needlework::python {

/// Rates, the ratio of temperatures, cooling curves.
void add_theory(pybind11::module_& module);
/// First contacts of pairs.
void add_prediction(pybind11::module_& module);
/// StandardDescriptors.
void add_descriptors(pybind11::module_& module);
/// Simulations.
void add_run(pybind11::module_& module);

}  // namespace needlework::python
