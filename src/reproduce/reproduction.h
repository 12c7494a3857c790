// Figures of the paper from finished runs: files, and rows that compare them with the claims.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "src/reproduce/claims.h"
#include "src/reproduce/figure.h"

namespace needlework::reproduce {

/// A claim with a measurement of it.
struct Row {
  Claim claim;         ///< with what is stated of this variant
  std::string figure;  ///< that measured it
  std::string variant;
  Measured measured;
  Verdict verdict = Verdict::open;

  /// The claim and its variant, unique among all rows.
  std::string id() const;
};

/// Makes a figure of runs that are finished, writes figure-NAME.csv and figure-NAME.svg into the
/// folder of the runs, and compares its measurements with their claims. Throws std::logic_error for
/// a measurement without a claim.
std::vector<Row> reproduce(const Figure& figure, const PaperRuns& runs,
                           std::span<const Claim> claims);

/// The rows as one JSON object, {"size": ..., "claims": [...]}, a row a line.
std::string json_of(std::span<const Row> rows, Size size);

/// Writes a file as a whole: it has its name only when it is complete. Throws IoError.
void write_text(const std::string& path, const std::string& text);

/// Numbers separated by commas, under a line with the names of the columns; nothing for NaN.
std::string csv_of(const Table& table);

}  // namespace needlework::reproduce
