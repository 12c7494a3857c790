#include "src/cli/reproduce_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/cli/python_module.h"

namespace needlework::cli {
namespace {

struct Group {
  const char* title;
  std::vector<std::string> figures;
};

const std::vector<Group>& groups() {
  static const std::vector<Group> all{
      {"of the paper", {"2", "3", "4", "5a", "5b", "6", "7", "8"}},
      {"of its text", {"fluctuations", "moment", "rotation", "relaxation"}},
      {"rough bodies", {"rough", "rough-spheres"}},
      {"larger systems", {"sizes", "dense-large", "dense-film", "clusters"}},
      {"why they differ", {"cells", "tc-dilute", "tc-dense", "sliding-dilute", "sliding-dense"}},
      {"why theory is off",
       {"boltzmann-relaxation", "boltzmann-cooling", "boltzmann-ratio", "encounters"}},
      {"driven", {"kicked", "vibrated", "shear"}},
      {"between walls", {"piston", "channels", "walls", "sedimentation", "settling"}},
      {"rods", {"rods", "rods-flow", "nematic"}},
      {"sliding contact", {"sliding"}},
      {"liquid", {"liquid", "liquid-correlations"}},
      {"fixed bodies", {"obstacles"}},
      {"growth", {"packings"}}};
  return all;
}

}  // namespace

std::vector<std::string> names_of_figures() {
  std::vector<std::string> names{"all"};
  for (const Group& group : groups()) {
    names.insert(names.end(), group.figures.begin(), group.figures.end());
  }
  return names;
}

std::string help_on_figures() {
  std::string text = "Figures:\n";
  for (const Group& group : groups()) {
    text += fmt::format("  {:<19}{}\n", group.title, fmt::join(group.figures, ", "));
  }
  return text;
}

int run(const ReproduceArguments& arguments) {
  std::vector<std::string> words{arguments.figure, "--program", path_of_program()};
  // "--out=DIR", as a folder's name may begin with a hyphen.
  if (arguments.out) words.push_back("--out=" + *arguments.out);
  if (arguments.data) words.push_back("--from=" + *arguments.data);
  if (arguments.threads) words.push_back("--threads=" + std::to_string(*arguments.threads));
  if (arguments.quick) words.push_back("--quick");
  if (arguments.json) words.push_back("--json");
  if (arguments.quiet) words.push_back("--quiet");
  if (arguments.force) words.push_back("--force");
  return become_python("needlework.reproduce", words);
}

}  // namespace needlework::cli
