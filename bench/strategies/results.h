// The results of measuring a subset: as a table, as JSON, and as a compact file that can be read
// again.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/strategies/measure.h"

namespace needlework::bench {

/// One case. A compact file stores name, is_baseline, us_per_collision, and which search and
/// calendar did the work.
struct CaseResult {
  std::string name;  ///< of the case; begins with the name of its scene and '/'
  bool is_baseline = false;
  /// Time of the event loop [us], one value for each repetition, to five digits: CPU time, or wall
  /// time if the clock of the results is the wall's.
  std::vector<double> us_per_collision;
  std::string warm_up_hash;
  /// All other measured values, for --json only; of results that were read from a file, search and
  /// queue alone, if it has them.
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

/// Time of the case divided by that of its baseline, for each repetition.
std::vector<double> relative_costs(const Results& results, const CaseResult& result);

double median(std::vector<double> values);

/// Time of the baseline over that of the case, so that 2 is twice as fast: the median over
/// repetitions, and two values between which the true median lies in 95 of 100 cases or more, by
/// the sign test. They are NaN for fewer than six repetitions.
struct Speedup {
  double median, low, high;
};
Speedup speedup(const Results& results, const CaseResult& result);

/// Whether times are wall times, as they are where cases have different numbers of threads.
bool by_wall_clock(const Results& results);

/// The result of a case before it is measured.
CaseResult empty_result(const Case& one);

/// Adds a repetition, of which the wall time or the CPU time counts. Throws InvalidStateError if
/// its trajectory differs from that of previous ones.
void add_sample(CaseResult& result, const Sample& sample, bool by_wall_clock);

/// All measured values.
nlohmann::ordered_json json_of(const Results& results);

/// A line for each case, with a field for each part of its name.
std::string csv_of(const Results& results);

/// The data for read_results and the origin of the results; one line for each case.
std::string compact_text(const Results& results);

/// Throws IoError for a file that cannot be read, and InputError for one that compact_text has not
/// written.
Results read_results(const std::string& file);

/// A table for readers, one line for each case. The content of a compact file is enough.
std::string table_of(const Results& results);

}  // namespace needlework::bench
