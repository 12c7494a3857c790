// Makes event loops. A loop is compiled for each search and each set of effects of the model; the
// loops of one search are in one file, loops/*.cpp. The calendar is chosen at run time.
#pragma once

#include <memory>
#include <string>

#include "src/engine/loop.h"
#include "src/engine/replaced_records.h"
#include "src/search/setup.h"

namespace needlework {

/// The parts of a loop, by name.
struct LoopChoice {
  std::string search;    ///< not "auto"
  std::string calendar;  ///< not "auto"
  int threads = 1;
  std::string threads_place = {};  ///< who asked for them, for messages: "engine.threads = 2"
  bool all_threads = false;        ///< whether they work together even where one alone is faster
  SearchSetup setup = {};
  ReplacedRecords replaced = {};  ///< records that were replaced at the present time
};

/// Makes the loop with these parts, for the effects `run.effects`. `run` must outlive it. The
/// names must be known, and for several threads if there are some, as in a valid scene
/// (src/scene/validity.h); else it throws std::logic_error, or InputError for the calendar.
std::unique_ptr<Loop> make_loop(Run& run, LoopChoice choice);

}  // namespace needlework
