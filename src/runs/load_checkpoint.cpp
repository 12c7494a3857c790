#include "src/runs/load_checkpoint.h"

#include "src/runs/engine_choice.h"

namespace needlework::runs {

CheckpointFiles::Latest load_checkpoint(const std::string& output_file,
                                        const std::function<void(Scene&)>& change) {
  CheckpointFiles::Latest latest = CheckpointFiles(output_file).latest();
  Scene& scene = latest.checkpoint.scene;
  scene.output.file = scene.places["output.file"] = output_file;
  scene.engine.isa = "auto";
  if (change) change(scene);
  choose_engine(scene);
  return latest;
}

std::string joined(const std::string& first, const std::string& second) {
  return first.empty() || second.empty() ? first + second : first + "; " + second;
}

}  // namespace needlework::runs
