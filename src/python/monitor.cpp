#include "src/python/monitor.h"

#include "src/python/interpreter.h"
#include "src/runs/progress_text.h"

namespace needlework::python {

namespace py = pybind11;

/// Time between two lines of progress [s].
constexpr double interval = 0.5;

std::exception_ptr handle_signals() {
  const LockTaken lock;
  if (PyErr_CheckSignals() == 0) return nullptr;
  return std::make_exception_ptr(py::error_already_set());
}

void Monitor::show(const runs::Progress& progress) {
  next_ = progress.elapsed + interval;
  const std::string line = runs::progress_text(progress);
  const LockTaken lock;
  try {
    call(show_, text(line));
  } catch (...) {
    failure_ = std::current_exception();
  }
}

bool Monitor::stop_requested() const {
  if (failure_) return true;
  failure_ = handle_signals();
  return failure_ != nullptr;
}

}  // namespace needlework::python
