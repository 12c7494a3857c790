#include "src/runs/resources.h"

#include <sys/resource.h>

#include <ctime>
#include <fstream>

#include "src/machine/descriptors.h"

namespace needlework::runs {
namespace {

const auto launch = std::chrono::steady_clock::now();

double seconds_of(clockid_t clock) {
  std::timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::string processor_name() {
  const StandardDescriptors occupied;
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

void Stopwatch::start() {
  wall_start_ = std::chrono::steady_clock::now();
  cpu_start_ = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  thread_cpu_start_ = seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

void Stopwatch::stop() {
  thread_cpu_ += seconds_of(CLOCK_THREAD_CPUTIME_ID) - thread_cpu_start_;
  cpu_ += seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_start_;
  wall_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start_).count();
}

double seconds_since_launch() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - launch).count();
}

}  // namespace needlework::runs
