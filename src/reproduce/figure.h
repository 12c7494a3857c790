// What a figure is made of and what comes out of it.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "src/picture/chart.h"
#include "src/reproduce/paper_runs.h"
#include "src/reproduce/verdict.h"

namespace needlework::reproduce {

/// Numbers in columns.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

/// A measurement for a claim.
struct Measurement {
  std::string claim;  ///< id
  std::string
      variant;  ///< of what it is, such as "k = 6, T_rot(0) = 1"; empty if there is one only
  Measured measured;
  /// What is stated, where it depends on the variant, as a prediction of theory does.
  std::optional<Stated> stated = {};
};

struct FigureResult {
  Table table;
  picture::Chart chart;
  std::vector<Measurement> measurements;
};

struct Figure {
  std::string name;  ///< as the command takes it
  std::string title;
  std::vector<std::string> sets;  ///< runs that it needs
  FigureResult (*make)(const PaperRuns& runs);
};

/// All figures, those of the paper first.
std::span<const Figure> figures();

/// Null if there is none of this name.
const Figure* find_figure(std::string_view name);

}  // namespace needlework::reproduce
