#include "src/machine/available_cores.h"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "src/machine/control_groups.h"
#include "src/machine/descriptors.h"

namespace needlework {
namespace {

using std::filesystem::path;

struct Quota {
  double cores;
  path file;
};

// Version 2: "QUOTA PERIOD" or "max PERIOD", in microseconds.
std::optional<Quota> quota_of_version_2(const path& group) {
  const path file = group / "cpu.max";
  double quota = 0, period = 0;
  const StandardDescriptors occupied;
  if (!(std::ifstream(file) >> quota >> period) || quota <= 0 || period <= 0) return {};
  return Quota{quota / period, file};
}

// Version 1: a file for each, with a quota of -1 where there is no limit.
std::optional<Quota> quota_of_version_1(const path& group) {
  const path file = group / "cpu.cfs_quota_us";
  double quota = 0, period = 0;
  const StandardDescriptors occupied;
  if (!(std::ifstream(file) >> quota) || quota <= 0) return {};
  if (!(std::ifstream(group / "cpu.cfs_period_us") >> period) || period <= 0) return {};
  return Quota{quota / period, file};
}

std::optional<Quota> least_quota(const path& root) {
  std::optional<Quota> least;
  for (const path& group : control_groups("cpu", root)) {
    for (const auto& quota : {quota_of_version_2(group), quota_of_version_1(group)}) {
      if (quota && (!least || quota->cores < least->cores)) least = quota;
    }
  }
  return least;
}

std::optional<int> whole_number_in_environment(const char* name) {
  const char* text = std::getenv(name);
  if (!text) return {};
  char* end = nullptr;
  const long number = std::strtol(text, &end, 10);
  if (end == text || *end != '\0' || number < 1) return {};
  return static_cast<int>(std::min(number, 1L << 20));
}

std::string number_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

}  // namespace

int AvailableCores::usable() const {
  int least = std::min(online, affinity);
  if (quota) least = std::min(least, static_cast<int>(std::min(*quota, 1e6)));
  if (slurm_per_task) least = std::min(least, *slurm_per_task);
  return std::max(1, least);
}

std::string AvailableCores::text() const {
  std::vector<std::string> limits;
  if (affinity < online) limits.push_back("the process may run on " + std::to_string(affinity));
  if (quota && *quota < online) {
    limits.push_back("CPU quota of " + number_text(*quota) + " (" + quota_file.string() + ")");
  }
  if (slurm_per_task && *slurm_per_task < online) {
    limits.push_back("SLURM_CPUS_PER_TASK=" + std::to_string(*slurm_per_task));
  }
  std::string out = std::to_string(usable());
  if (limits.empty()) return out;
  out += " of " + std::to_string(online);
  const char* separator = ": ";
  for (const std::string& limit : limits) {
    out += separator + limit;
    separator = ", ";
  }
  return out;
}

AvailableCores available_cores(const path& root) {
  AvailableCores out;
  out.affinity = std::max(1, omp_get_num_procs());
  out.online = std::max(out.affinity, static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
  if (const std::optional<Quota> quota = least_quota(root)) {
    out.quota = quota->cores;
    out.quota_file = quota->file;
  }
  out.slurm_per_task = whole_number_in_environment("SLURM_CPUS_PER_TASK");
  return out;
}

}  // namespace needlework
