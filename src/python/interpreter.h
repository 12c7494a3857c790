// The interpreter's lock, for threads that may outlive the interpreter, and its text.
#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>

#include <exception>
#include <string>
#include <utility>

namespace needlework::python {

// Python ends while daemon threads are running. One that then asks for the lock is ended by
// pthread_exit(), which unwinds its stack as an exception does and aborts the process where it
// meets a function that must not throw, such as a destructor. And one that goes on computing meets
// the destructors of static objects. So these threads wait here for the end of the process instead:
// from the moment at which Python begins to end, at the next place where they ask for the lock.

/// To be called once: Python's end then waits a moment for threads within without_lock().
void park_threads_at_exit(pybind11::module_& module);

/// Gives the lock up, and takes it again. Called by without_lock() alone.
class LockGivenUp {
 public:
  LockGivenUp();
  void take_again();  ///< does not return once Python ends

 private:
  PyThreadState* state_;
};

/// Calls the function without the lock, which the caller holds.
template <class Action>
void without_lock(Action&& action) {
  LockGivenUp lock;
  std::exception_ptr failure;
  try {
    action();
  } catch (...) {
    failure = std::current_exception();
  }
  lock.take_again();
  if (failure) std::rethrow_exception(failure);
}

/// Holds the lock during its life. Its constructor does not return once Python ends.
class LockTaken {
 public:
  LockTaken();
  ~LockTaken() { PyGILState_Release(state_); }
  LockTaken(const LockTaken&) = delete;
  LockTaken& operator=(const LockTaken&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Whether this thread must not ask for the lock any more, as Python ends in another one.
bool has_ended_here() noexcept;

/// Calls a function of Python with one argument, and throws what it raises. The caller holds the
/// lock. Does not return if Python ends meanwhile.
pybind11::object call(pybind11::handle function, pybind11::handle argument);

/// Text of the library, which may hold names of files that are not UTF-8: as os.fsdecode() has
/// them.
pybind11::str text(const std::string& bytes);

}  // namespace needlework::python
