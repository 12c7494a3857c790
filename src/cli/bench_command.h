// `needlework bench`: measures named subsets of scenes or a given scene, and compares results.
#pragma once

#include <string>

#include "bench/strategies/own_scene.h"

namespace needlework::cli {

struct BenchArguments {
  std::string subset = "quick";
  bool list = false, json = false, quiet = false, force = false;
  std::string json_file, csv_file, compare, results;
  bench::OwnScene own;  ///< measured in place of the subset if its file is given
  int repetitions = 5;
  double min_time = 0.25;
};

/// Returns the exit code.
int run(const BenchArguments& arguments);

/// Their names with | between them, and when --compare calls a case faster or slower.
std::string names_of_subsets();
std::string help_on_verdicts();

}  // namespace needlework::cli
