// `needlework reproduce`: the figures and claims of the paper.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace needlework::cli {

struct ReproduceArguments {
  std::string figure;
  std::optional<std::string> out;
  std::optional<int> threads;
  bool quick = false, json = false, quiet = false, force = false;
};

/// What may be asked for: the figures, and all.
std::vector<std::string> names_of_figures();

/// Returns the exit code.
int run(const ReproduceArguments& arguments);

}  // namespace needlework::cli
