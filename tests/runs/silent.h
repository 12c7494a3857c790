// Runs that nobody watches, in a folder of their own.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "src/runs/prepared_run.h"
#include "src/runs/run_monitor.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {

struct Silent : RunMonitor {
  bool is_due(double) const override { return false; }
  void show(const Progress&) override {}
};

class InRunFolder : public testing::Test {
 protected:
  /// Goes on to the end of the scene, and closes the file.
  void finish(PreparedRun& run) {
    run.advance(run.scene().until, monitor);
    run.close();
  }

  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.h5";
  Silent monitor;
};

}  // namespace needlework::runs
