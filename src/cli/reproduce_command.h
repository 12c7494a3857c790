// `needlework reproduce`: the figures and claims of the paper, which the Python package makes.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace needlework::cli {

struct ReproduceArguments {
  std::string figure;
  std::optional<std::string> out, data;
  std::optional<int> threads;
  bool quick = false, json = false, quiet = false, force = false;
};

/// What may be asked for: all, and the figures as python/needlework/reproduce/figures.py names
/// them, which a test compares. They are here too so that usage and help need no Python.
std::vector<std::string> names_of_figures();
/// The figures in groups, for --help.
std::string help_on_figures();

/// Returns the exit code if Python cannot be run; else this process becomes Python.
int run(const ReproduceArguments& arguments);

}  // namespace needlework::cli
