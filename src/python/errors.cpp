#include "src/python/errors.h"

#include <exception>
#include <new>
#include <stdexcept>

#include "needlework/error.h"
#include "src/python/interpreter.h"
#include "src/runs/failure.h"

namespace needlework::python {
namespace {

namespace py = pybind11;

void raise(const char* name, const std::exception& error) {
  const py::object type = py::module_::import("needlework.errors").attr(name);
  PyErr_SetObject(type.ptr(), text(error.what()).ptr());
}

}  // namespace

void translate_errors() {
  py::register_local_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const needlework::InputError& error) {
      raise("InputError", error);
    } catch (const std::invalid_argument& error) {  // of the theory
      raise("InputError", error);
    } catch (const needlework::InvalidStateError& error) {
      raise("InvalidStateError", error);
    } catch (const needlework::IoError& error) {
      raise("IoError", error);
    } catch (const UseError& error) {
      raise("Error", error);
    } catch (const std::bad_alloc&) {
      PyErr_SetString(PyExc_MemoryError, runs::current_failure().message.c_str());
    } catch (const std::length_error&) {
      PyErr_SetString(PyExc_MemoryError, runs::current_failure().message.c_str());
    }
  });
}

}  // namespace needlework::python
