#include "src/memory/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

namespace needlework {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

// The number in a file that holds one; infinity if it is absent or says "max".
double number_in(const std::string& path) {
  double number = 0;
  return std::ifstream(path) >> number ? number : unlimited;
}

double memory_available_in_machine() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    double kibibytes = 0;
    if (words >> name >> kibibytes && name == "MemAvailable:") return kibibytes * 1024;
  }
  return unlimited;
}

// The least limit of the process's control group and of those it lies in, of version 2 or 1.
double memory_limit_of_control_group() {
  double limit = unlimited;
  std::ifstream file("/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {  // ID:CONTROLLERS:PATH
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool version_2 = controllers.empty();
    if (!version_2 && controllers != "memory") continue;
    const std::string root = version_2 ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    const std::string leaf = version_2 ? "/memory.max" : "/memory.limit_in_bytes";
    for (std::string path = line.substr(second + 1);; path.resize(path.rfind('/'))) {
      limit = std::min(limit, number_in(root + path + leaf));
      if (path.rfind('/') == std::string::npos) break;
    }
  }
  return limit;
}

}  // namespace

double available_memory() {
  return std::min(memory_available_in_machine(), memory_limit_of_control_group());
}

}  // namespace needlework
