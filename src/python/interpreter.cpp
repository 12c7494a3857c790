#include "src/python/interpreter.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace needlework::python {

namespace py = pybind11;

namespace {

/// For how long Python's end waits for threads. They look for it ten times a second or more.
constexpr std::chrono::seconds longest_wait{1};

std::atomic<bool> ending = false;
std::atomic<std::thread::id> ending_thread;
std::atomic<int> at_work = 0;  // threads within without_lock() that are not parked
thread_local int depth = 0;    // of without_lock() in this thread: callbacks may use it again

void begin_work() {
  if (depth++ == 0) ++at_work;
}

void end_work() {
  if (--depth == 0) --at_work;
}

[[noreturn]] void park() {
  if (depth > 0) --at_work;
  for (;;) pause();
}

void wait_for_threads() {
  ending_thread = std::this_thread::get_id();
  ending = true;
  PyThreadState* const state = PyEval_SaveThread();
  const auto last = std::chrono::steady_clock::now() + longest_wait;
  while (at_work > 0 && std::chrono::steady_clock::now() < last) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  PyEval_RestoreThread(state);
}

// Python may end just before the lock is there, and then ends the thread.
template <class Take>
auto take_lock(Take&& take) {
  if (has_ended_here()) park();
  try {
    return take();
  } catch (abi::__forced_unwind&) {
    park();
  }
}

}  // namespace

bool has_ended_here() noexcept {
  return ending && ending_thread.load() != std::this_thread::get_id();
}

void park_threads_at_exit(py::module_& module) {
  module.def("_wait_for_threads", wait_for_threads);
  // Threads that were at work are not there in a forked child.
  pthread_atfork(nullptr, nullptr, [] { at_work = depth > 0 ? 1 : 0; });
  py::module_::import("atexit").attr("register")(module.attr("_wait_for_threads"));
}

LockGivenUp::LockGivenUp() : state_(PyEval_SaveThread()) { begin_work(); }

void LockGivenUp::take_again() {
  take_lock([&] { PyEval_RestoreThread(state_); });
  end_work();
}

LockTaken::LockTaken() : state_(take_lock([] { return PyGILState_Ensure(); })) {}

py::object call(py::handle function, py::handle argument) {
  PyObject* result = nullptr;
  try {
    // Of C alone, so that nothing is freed without the lock when the thread is ended in it.
    result = PyObject_CallFunctionObjArgs(function.ptr(), argument.ptr(), nullptr);
  } catch (abi::__forced_unwind&) {
    park();
  }
  if (!result) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(result);
}

py::str text(const std::string& bytes) {
  PyObject* const decoded =
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "surrogateescape");
  if (!decoded) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

}  // namespace needlework::python
