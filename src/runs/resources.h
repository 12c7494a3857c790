// What this machine offers and what the process has used of it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "src/machine/available_memory.h"

namespace needlework::runs {

using needlework::available_memory;

/// Most memory that the process has held so far [bytes].
std::uint64_t peak_memory();

/// What the processor calls itself, or "unknown".
std::string processor_name();

/// Wall and CPU time of the stretches between start() and stop() [s], which one thread calls.
class Stopwatch {
 public:
  void start();
  void stop();
  double wall() const { return wall_; }
  double cpu() const { return cpu_; }                ///< of all threads of the process
  double thread_cpu() const { return thread_cpu_; }  ///< of the calling thread

 private:
  std::chrono::steady_clock::time_point wall_start_;
  double cpu_start_ = 0, thread_cpu_start_ = 0;
  double wall_ = 0, cpu_ = 0, thread_cpu_ = 0;
};

/// Seconds since the program began, of wall time.
double seconds_since_launch();

}  // namespace needlework::runs
