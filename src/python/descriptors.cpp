// A block in which no file takes the place of standard streams that are closed.
#include "src/machine/descriptors.h"

#include <pybind11/pybind11.h>

#include <memory>

#include "src/python/parts.h"

namespace needlework::python {

namespace py = pybind11;

namespace {

struct Block {
  std::unique_ptr<StandardDescriptors> occupied;
};

}  // namespace

void add_descriptors(py::module_& module) {
  py::class_<Block>(module, "StandardDescriptors")
      .def(py::init())
      .def("__enter__",
           [](Block& block) -> Block& {
             block.occupied = std::make_unique<StandardDescriptors>();
             return block;
           })
      .def("__exit__", [](Block& block, const py::args&) { block.occupied.reset(); });
}

}  // namespace needlework::python
