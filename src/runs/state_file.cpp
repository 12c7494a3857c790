#include "src/runs/state_file.h"

#include "needlework/h5md.h"
#include "src/runs/output_path.h"
#include "src/scene/accuracy.h"

namespace needlework::runs {

io::RunInfo run_info(const Simulation& simulation, const Scene& scene) {
  return {.isa = simulation.isa(),
          .threads = scene.engine.threads.value_or(1),
          .epoch_length = simulation.epoch_length(),
          .accuracy = accuracy_name(scene.engine)};
}

void write_state(const Simulation& simulation, const Scene& scene, const std::string& path,
                 bool force) {
  require_writable(path, force, path);
  Scene without_events = scene;
  without_events.output.events = false;
  io::Writer writer(path, force, without_events, run_info(simulation, scene));
  const Totals totals = simulation.totals();
  writer.write_series(totals);
  writer.write_frame(totals, simulation.copy());
  writer.close();
}

}  // namespace needlework::runs
