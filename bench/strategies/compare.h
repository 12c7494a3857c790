// Two results of the same cases: which became faster.
#pragma once

#include <string>
#include <vector>

#include "bench/strategies/results.h"

namespace needlework::bench {

/// Costs so near to each other are the same.
inline constexpr double same_within = 0.03;

/// How a case is judged, for people.
extern const char* const rule_of_verdicts;

/// A quotient new / old, with the bounds between which it is in 95 of 100 comparisons.
struct Change {
  double estimate, low, high;
};

/// The change from the values in `before` to those in `after`, by the differences of their
/// logarithms pair by pair: their median (Hodges and Lehmann 1963) and the interval of Mann and
/// Whitney's rank test, which supposes no distribution. The bounds are 0 and infinity when there
/// are too few values: three and four, say.
Change change_between(const std::vector<double>& before, const std::vector<double>& after);

/// "faster", "slower", "same" or "unclear".
std::string verdict_of(const Change& change);

struct Comparison {
  std::string text;  ///< a table for people
  nlohmann::ordered_json json;
  bool differs = false;  ///< whether a case became faster or slower
};

/// Throws InputError if no case is in both; needs names only.
void require_common_case(const Results& before, const Results& after);
/// What else than the code may have changed the costs: machine, compiler, flags. A line for each.
std::vector<std::string> unlike(const Results& before, const Results& after);
/// Compares all cases that are in both.
Comparison compare(const Results& before, const Results& after);

}  // namespace needlework::bench
