// `needlework bench`: measures named subsets of scenes, and compares results.
#pragma once

#include <string>

namespace needlework::cli {

struct BenchArguments {
  std::string subset = "quick";
  bool list = false, json = false, quiet = false, force = false;
  std::string json_file, compare, results;
  int repetitions = 5;
  double min_time = 0.25;
};

/// Returns the exit code.
int run(const BenchArguments& arguments);

/// Their names with | between them, and when --compare calls a case faster or slower.
std::string names_of_subsets();
std::string help_on_verdicts();

}  // namespace needlework::cli
