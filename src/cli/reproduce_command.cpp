#include "src/cli/reproduce_command.h"

#include "src/cli/python_module.h"

namespace needlework::cli {

std::vector<std::string> names_of_figures() {
  return {"all",
          "2",
          "3",
          "4",
          "5a",
          "5b",
          "6",
          "7",
          "8",
          "fluctuations",
          "moment",
          "rotation",
          "relaxation",
          "rough",
          "sizes",
          "dense-large",
          "dense-film",
          "clusters",
          "cells",
          "tc-dilute",
          "tc-dense",
          "sliding-dilute",
          "sliding-dense",
          "boltzmann-relaxation",
          "boltzmann-cooling",
          "boltzmann-ratio",
          "encounters",
          "kicked",
          "vibrated",
          "walls",
          "sedimentation",
          "settling",
          "rods",
          "rods-flow",
          "nematic",
          "sliding",
          "liquid",
          "liquid-correlations"};
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
