// The runs of the paper with a handful of needles each, which take a second in all.
#pragma once

#include <string>

#include "needlework/error.h"
#include "src/reproduce/embedded_files.h"

namespace needlework::reproduce::test {

/// Scenes and grids of the program, but with overriding parameters at the end of each grid.
inline std::string small_text(const std::string& path) {
  std::string text = embedded_text(path);
  const std::string name = path.substr(path.rfind('/') + 1);
  if (path.find("/full/") == path.npos || path.find("..") != path.npos) return text;
  const auto begins = [&](const char* word) { return name.starts_with(word); };
  std::string scene = "../" + name;
  std::string parameters = "\"needles.count\" = 40\n";
  if (begins("dense") || begins("box")) {
    scene = "../dense.toml";
    parameters = begins("box") ? "\"needles.count\" = 16\n" : parameters;
    const char* const box = begins("box-small")    ? "2.1"
                            : begins("box-large")  ? "2.3"
                            : begins("box-middle") ? "2.4"
                                                   : "2.2";
    parameters += std::string("\"needles.box\" = ") + box + "\n\"output.grid\" = 2\n";
    parameters += begins("box") ? "\"until.collisions_per_needle\" = 605\n"
                                : "\"until.collisions_per_needle\" = 30\n";
  } else if (begins("relaxation")) {
    parameters += "\"needles.box\" = [3, 4]\n\"until.time\" = 20\n";
  } else if (begins("ratio")) {
    parameters += "\"collisions.epsilon\" = [0.8]\n\"needles.k\" = [2, 4.3607]\n";
    parameters += "\"needles.box\" = 3\n\"until.energy_ratio\" = 1e-2\n";
  } else if (begins("rough")) {
    parameters += "\"collisions.epsilon\" = [0.7, 0.9]\n\"collisions.beta\" = [-0.5, 0.5]\n";
    parameters += "\"needles.box\" = 3\n\"until.energy_ratio\" = 1e-2\n";
  } else if (begins("elastic")) {
    parameters +=
        "\"needles.box\" = 3\n\"output.grid\" = 2\n\"until.collisions_per_needle\" = 20\n";
  } else {
    scene = "../dilute.toml";
    parameters += "\"needles.box\" = 3\n\"output.grid\" = 2\n\"until.energy_ratio\" = 1e-7\n";
  }
  if (begins("dense.")) parameters += "\"needles.k\" = [6, 2]\n\"initial.t_rot\" = [1, 0]\n";
  if (name.ends_with("-tc.toml")) parameters += "\"collisions.tc_relative\" = [1e-2, 1e-4]\n";
  return "scene = \"" + scene + "\"\nseeds = [1, 2, 3]\n[parameters]\n" + parameters;
}

}  // namespace needlework::reproduce::test
