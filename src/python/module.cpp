// The module needlework._core.
#include <pybind11/pybind11.h>

#include "src/python/errors.h"
#include "src/python/interpreter.h"
#include "src/python/parts.h"

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of needlework. Use the package needlework, which documents it.";
  module.attr("version") = NEEDLEWORK_VERSION;
  needlework::python::translate_errors();
  needlework::python::park_threads_at_exit(module);
  needlework::python::add_descriptors(module);
  needlework::python::add_theory(module);
  needlework::python::add_prediction(module);
  needlework::python::add_run(module);
}
