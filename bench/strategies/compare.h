// Compares two results of the same cases, to find which have become faster.
#pragma once

#include <string>
#include <vector>

#include "bench/strategies/results.h"

namespace needlework::bench {

/// Costs that differ by less than this count as the same.
inline constexpr double same_within = 0.03;

/// The rule by which a case is judged, as text for readers.
extern const char* const rule_of_verdicts;

/// A quotient new / old, and its 95 % confidence interval.
struct Change {
  double estimate, low, high;
};

/// The change from the values in `before` to those in `after`. It is estimated from the
/// differences of their logarithms between all pairs: the median (Hodges and Lehmann 1963), and
/// the interval of Mann and Whitney's rank test, which assumes no distribution. The bounds are 0
/// and infinity if there are too few values, such as three and four.
Change change_between(const std::vector<double>& before, const std::vector<double>& after);

/// "faster", "slower", "same" or "unclear".
std::string verdict_of(const Change& change);

struct Comparison {
  std::string text;  ///< a table for readers
  nlohmann::ordered_json json;
  bool differs = false;  ///< whether a case became faster or slower
};

/// Throws InputError if no case is in both, and no two differ in one part of their names alone.
/// Only names are used.
void require_common_case(const Results& before, const Results& after);
/// What may have changed the costs besides the code: machine, compiler, flags. One line for each.
std::vector<std::string> unlike(const Results& before, const Results& after);
/// Compares all cases that are in both. If none is, but the cases of both differ in one part of
/// their names alone, such as the accuracy, the cases that else have the same name are compared, by
/// the times themselves, as the baselines differ as well.
Comparison compare(const Results& before, const Results& after);

}  // namespace needlework::bench
