// What measuring a subset gives: as a table, as JSON, and as a compact file that can be read again.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/strategies/measure.h"

namespace needlework::bench {

/// One case. A compact file keeps name, is_baseline and us_per_collision.
struct CaseResult {
  std::string name;  ///< of the case; begins with the name of its scene and '/'
  bool is_baseline = false;
  /// CPU time of the event loop [us], one value for each repetition, to five digits.
  std::vector<double> us_per_collision;
  std::string warm_up_hash;
  /// All else that was measured, for --json alone; empty in results that were read.
  nlohmann::ordered_json details = nlohmann::ordered_json::object();

  std::string scene() const;
  double least() const;   ///< of us_per_collision
  double median() const;  ///< of us_per_collision
  double most() const;    ///< of us_per_collision
};

struct Results {
  nlohmann::ordered_json about;  ///< subset, machine, compiler, flags, version, date, ...
  std::vector<CaseResult> cases;

  /// The baseline of a case's scene.
  const CaseResult& baseline_of(const CaseResult& result) const;
};

/// The text at this key, "?" if there is none.
std::string about_text(const nlohmann::ordered_json& about, const char* key);

/// Time of the case over that of its baseline, by repetition.
std::vector<double> relative_costs(const Results& results, const CaseResult& result);

double median(std::vector<double> values);

/// What is known of a case before it is measured.
CaseResult empty_result(const Case& one);

/// Adds a repetition. Throws InvalidStateError if its trajectory is not that of those before.
void add_sample(CaseResult& result, const Sample& sample);

/// All that was measured.
nlohmann::ordered_json json_of(const Results& results);

/// What read_results needs, and what says where it is from; one line for each case.
std::string compact_text(const Results& results);

/// Throws IoError for a file that cannot be read, and InputError for one without the content of
/// compact_text.
Results read_results(const std::string& file);

/// A table for people, one line for each case. Needs no more than a compact file has.
std::string table_of(const Results& results);

}  // namespace needlework::bench
