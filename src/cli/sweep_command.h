// `needlework sweep`: a grid of parameters and seeds, and what its runs have in common.
#pragma once

#include <optional>
#include <string>

namespace needlework::cli {

struct SweepArguments {
  std::string grid;
  std::optional<std::string> member, out, isa, log;
  std::optional<int> threads;
  std::optional<double> progress_every;  ///< [s]
  bool summary = false, json = false, csv = false, quiet = false, force = false;
};

/// Returns the exit code.
int run(const SweepArguments& arguments);

}  // namespace needlework::cli
