#include "src/runs/state_file.h"

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/atomic_file.h"
#include "src/scene/accuracy.h"

namespace needlework::runs {

io::RunInfo run_info(const Simulation& simulation, const Scene& scene) {
  return {.isa = simulation.isa(),
          .threads = scene.engine.threads.value_or(1),
          .epoch_length = simulation.epoch_length(),
          .accuracy = accuracy_name(scene.engine),
          .species = simulation.species(),
          .own_bodies = simulation.own_bodies_at_start(),
          .has_kinds = !simulation.sources().empty() || simulation.sliding_contacts()};
}

void write_state(const Simulation& simulation, const Scene& scene, const UserDataByName& data,
                 const std::string& path, bool force) {
  Scene without_events = scene;
  without_events.output.events = false;
  io::AtomicFile file(path, force);
  try {
    io::Writer writer(file.temporary(), true, without_events, run_info(simulation, scene));
    const Totals totals = simulation.totals();
    writer.write_series(totals);
    writer.write_frame(totals, simulation.copy());
    for (const auto& [name, value] : data) writer.write_data(totals, name, &value);
    writer.close();
  } catch (const IoError& error) {
    std::string message = error.what();
    if (message.starts_with(file.temporary())) message.replace(0, file.temporary().size(), path);
    throw IoError(message);
  }
  file.publish();
}

}  // namespace needlework::runs
