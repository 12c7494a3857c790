// What came of measuring a subset: as a table, and as a file that can be read again.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/strategies/measure.h"

namespace needlework::bench {

/// Of one case; what is measured has one value for each repetition.
struct CaseResult {
  std::string name, scene;
  bool is_baseline = false;
  std::uint64_t needles = 0;
  double density = 0;                       ///< [L^-3]
  std::string search, queue, isa, effects;  ///< in use, `auto` resolved
  std::string warm_up_hash;
  std::vector<double> us_per_collision;  ///< CPU time of the event loop [us]
  std::vector<double> setup_s;           ///< CPU time [s]
  std::vector<std::uint64_t> collisions;
  std::vector<double> bytes_per_needle;
  nlohmann::ordered_json per_collision;  ///< counters by name, of the last repetition

  double best() const;    ///< least us_per_collision
  double median() const;  ///< of us_per_collision
};

struct Results {
  nlohmann::ordered_json about;  ///< subset, machine, compiler, flags, version, date, ...
  std::vector<CaseResult> cases;

  /// The baseline of a case's scene.
  const CaseResult& baseline_of(const CaseResult& result) const;
};

/// What is told under this key, "?" if nothing.
std::string about_text(const nlohmann::ordered_json& about, const char* key);

/// Time of the case over that of its baseline, by repetition.
std::vector<double> relative_costs(const Results& results, const CaseResult& result);

double median(std::vector<double> values);

/// Adds a repetition. Throws InvalidStateError if its trajectory is not that of those before.
void add_sample(CaseResult& result, const Sample& sample);

nlohmann::ordered_json json_of(const Results& results);

/// Throws IoError for a file that cannot be read, and InputError for one that json_of has not made.
Results read_results(const std::string& file);

/// Lines for people, a table of one line a case.
std::string table_of(const Results& results);

}  // namespace needlework::bench
