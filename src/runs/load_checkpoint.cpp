#include "src/runs/load_checkpoint.h"

#include "src/runs/engine_choice.h"

namespace needlework::runs {

CheckpointFiles::Read load_checkpoint(const std::string& output_file,
                                      const std::function<void(Scene&)>& change) {
  CheckpointFiles::Read read = CheckpointFiles(output_file).read();
  Scene& scene = read.checkpoint.scene;
  scene.output.file = scene.places["output.file"] = output_file;
  scene.engine.isa = "auto";
  if (change) change(scene);
  choose_engine(scene);
  return read;
}

}  // namespace needlework::runs
