#include "src/machine/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "src/machine/control_groups.h"
#include "src/machine/descriptors.h"

namespace needlework {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

// The number in a file that holds one; infinity if it is absent or says "max".
double number_in(const std::filesystem::path& path) {
  double number = 0;
  const StandardDescriptors occupied;
  return std::ifstream(path) >> number ? number : unlimited;
}

double memory_available_in_machine(const std::filesystem::path& root) {
  const StandardDescriptors occupied;
  std::ifstream file(root / "proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    double kibibytes = 0;
    if (words >> name >> kibibytes && name == "MemAvailable:") return kibibytes * 1024;
  }
  return unlimited;
}

}  // namespace

double available_memory(const std::filesystem::path& root) {
  double least = memory_available_in_machine(root);
  for (const std::filesystem::path& group : control_groups("memory", root)) {
    for (const char* limit : {"memory.max", "memory.limit_in_bytes"}) {
      least = std::min(least, number_in(group / limit));
    }
  }
  return least;
}

}  // namespace needlework
