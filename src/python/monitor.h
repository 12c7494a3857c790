// What Python sees of an advance while it lasts: signals and progress.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <string>

#include "src/runs/run_monitor.h"

namespace needlework::python {

/// Lets Python run the handlers of signals that have come, which it does in its main thread only.
/// Returns what one has thrown, such as KeyboardInterrupt, or null. Takes the GIL.
std::exception_ptr handle_signals();

/// Lets Python handle its signals, and shows progress. The thread that runs does not hold the GIL;
/// all members take it where they need it.
class Monitor : public runs::RunMonitor {
 public:
  /// `show` is called with a line of text, or is None. The caller holds the GIL.
  explicit Monitor(pybind11::object show) : show_(std::move(show)), quiet_(show_.is_none()) {}

  bool is_due(double elapsed) const override { return !quiet_ && elapsed >= next_; }
  void show(const runs::Progress& progress) override;
  bool stop_requested() const override;

  /// Throws what a handler of a signal has thrown, such as KeyboardInterrupt, or `show`.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  pybind11::object show_;
  bool quiet_;
  double next_ = 0.5;  ///< no line for advances that are shorter [s]
  mutable std::exception_ptr failure_;
};

}  // namespace needlework::python
