// A monitor for runs that nobody watches.
#pragma once

#include "src/runs/run_monitor.h"

namespace needlework::runs {

struct Silent : RunMonitor {
  bool is_due(double) const override { return false; }
  void show(const Progress&) override {}
};

}  // namespace needlework::runs
