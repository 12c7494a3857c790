// Runs of a few needles that fuzz targets begin with.
#pragma once

#include <optional>
#include <string>

#include "needlework/parse.h"
#include "src/runs/loaded_scene.h"
#include "src/runs/prepared_run.h"
#include "src/runs/run_monitor.h"
#include "tests/fuzz/target.h"

namespace needlework::fuzz {

/// Wants to see nothing.
class Silent : public runs::RunMonitor {
  bool is_due(double) const override { return false; }
  void show(const runs::Progress&) override {}
};

/// Runs a scene, which names its output file; what has become of contacts, if needles may slide.
inline std::optional<SlidingContacts> run_scene(const std::string& text) {
  runs::PreparedRun run(runs::complete_scene(parse_scene(text, "scene")), true, "scene");
  Silent silent;
  run.drive(silent);
  return run.simulation().sliding_contacts();
}

/// The output file of a run with events, frames and all observables.
inline std::string run_with_everything() {
  const std::string path = folder() / "run.h5";
  run_scene(R"(
needles = { count = 4, box = 3 }
collisions = { epsilon = 0.9, tc_relative = 1e-3 }
engine.threads = 1
until.collisions_per_needle = 10
output.series_per_decade = 2
output.frames = 1
output.events = true
output.grid = 1
output.observables = ["fields", "profiles", "flow_order", "distributions", "alignment",
    "velocity_moments", "temperature_by_axis", "pair_correlation", "structure_factor",
    "displacement", "time_correlation", "collision_statistics"]
output.file = ")" +
            path + "\"\n");
  return path;
}

}  // namespace needlework::fuzz
