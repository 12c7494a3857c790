#include "src/machine/control_groups.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "src/machine/descriptors.h"

namespace needlework {
namespace {

using std::filesystem::path;

bool contains_word(const std::string& list, const std::string& word) {
  std::istringstream words(list);
  for (std::string one; std::getline(words, one, ',');) {
    if (one == word) return true;
  }
  return false;
}

// Mount tables write blanks and the like as a backslash and three octal digits.
std::string without_escapes(const std::string& text) {
  std::string out;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const bool escaped = text[n] == '\\' && n + 3 < text.size() &&
                         std::all_of(text.begin() + static_cast<std::ptrdiff_t>(n) + 1,
                                     text.begin() + static_cast<std::ptrdiff_t>(n) + 4,
                                     [](char c) { return '0' <= c && c <= '7'; });
    out += escaped ? static_cast<char>(std::stoi(text.substr(n + 1, 3), nullptr, 8)) : text[n];
    if (escaped) n += 3;
  }
  return out;
}

struct Mount {
  std::string group;  // the control group that the mount shows
  path point;
  bool version_2;
};

// The mounted hierarchies with this controller, of /proc/self/mountinfo; see proc(5). The usual
// places count, too: sandboxes may show files of control groups there that are no mounts of them.
std::vector<Mount> mounts_of(const std::string& controller, const path& root) {
  const path usual = "/sys/fs/cgroup";
  std::vector<Mount> out{{"/", usual, true}, {"/", usual / controller, false}};
  const StandardDescriptors occupied;
  std::ifstream file(root / "proc/self/mountinfo");
  for (std::string line; std::getline(file, line);) {
    const auto dash = line.find(" - ");
    if (dash == std::string::npos) continue;
    std::istringstream front(line), back(line.substr(dash + 3));
    std::string skipped, group, point, type, options;
    front >> skipped >> skipped >> skipped >> group >> point;
    back >> type >> skipped >> options;
    const bool version_2 = type == "cgroup2";
    if (!version_2 && !(type == "cgroup" && contains_word(options, controller))) continue;
    out.push_back({without_escapes(group), without_escapes(point), version_2});
  }
  return out;
}

// The group of the process in the hierarchy of a mount; empty if there is none.
std::string group_of_process(const std::string& controller, bool version_2, const path& root) {
  const StandardDescriptors occupied;
  std::ifstream file(root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {  // ID:CONTROLLERS:PATH
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (version_2 ? controllers.empty() : contains_word(controllers, controller)) {
      return line.substr(second + 1);
    }
  }
  return "";
}

// The group as seen from the mount: "" is the group that the mount shows, also where the process
// seems to be outside of it, as the namespaces of containers may make it look.
std::string below(const std::string& shown, std::string group) {
  if (shown != "/") {
    const bool inside = group == shown || group.starts_with(shown + "/");
    group = inside ? group.substr(shown.size()) : "";
  }
  if (group.find("/..") != std::string::npos) return "";
  while (group.ends_with('/')) group.pop_back();
  return group;
}

}  // namespace

std::vector<path> control_groups(const std::string& controller, const path& root) {
  std::vector<path> out;
  for (const Mount& mount : mounts_of(controller, root)) {
    std::string group = below(mount.group, group_of_process(controller, mount.version_2, root));
    const path point = root / mount.point.relative_path();
    for (;; group.resize(group.rfind('/'))) {
      out.push_back(group.empty() ? point : point / group.substr(1));
      if (group.rfind('/') == std::string::npos) break;
    }
  }
  return out;
}

}  // namespace needlework
