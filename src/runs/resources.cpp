#include "src/runs/resources.h"

#include <sys/resource.h>

#include <ctime>
#include <fstream>

namespace needlework::runs {
namespace {

const auto launch = std::chrono::steady_clock::now();

double process_cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

void Stopwatch::start() {
  wall_start_ = std::chrono::steady_clock::now();
  cpu_start_ = process_cpu_seconds();
}

void Stopwatch::stop() {
  cpu_ += process_cpu_seconds() - cpu_start_;
  wall_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start_).count();
}

double seconds_since_launch() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - launch).count();
}

}  // namespace needlework::runs
