// Makes event loops. A loop is compiled for each search and each set of effects of the model, those
// of one search in a file of its own, loops/*.cpp. The calendar is chosen at run time.
#pragma once

#include <memory>
#include <string>

#include "src/engine/loop.h"
#include "src/engine/replaced_records.h"
#include "src/search/setup.h"

namespace needlework {

/// Parts of a loop, by name.
struct LoopChoice {
  std::string search;    ///< not "auto"
  std::string calendar;  ///< not "auto"
  int threads = 1;
  SearchSetup setup = {};
  ReplacedRecords replaced = {};  ///< records replaced at the present time
};

/// The loop with these parts, for the effects `run.effects`. `run` must outlive it. Throws
/// InputError for a name that does not exist, and for several threads where search and calendar
/// are for one.
std::unique_ptr<Loop> make_loop(Run& run, LoopChoice choice);

}  // namespace needlework
