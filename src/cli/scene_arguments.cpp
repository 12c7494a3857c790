#include "src/cli/scene_arguments.h"

#include <fmt/format.h>

#include <utility>

#include "src/cli/file_kind.h"
#include "src/runs/engine_choice.h"

namespace needlework::cli {

void apply(const EngineOptions& options, Scene& scene) {
  if (options.threads) {
    scene.engine.threads_by_size = *options.threads == "auto";
    scene.engine.threads.reset();
    if (!scene.engine.threads_by_size) scene.engine.threads = std::stoi(*options.threads);
    scene.places["engine.threads"] = "--threads " + *options.threads;
  }
  if (options.isa) {
    scene.engine.isa = *options.isa;
    scene.places["engine.isa"] = "--isa " + *options.isa;
    // The option comes before the environment, which counts where a scene says auto.
    if (scene.engine.isa == "auto") scene.engine.isa = runs::resolved_isa(scene.engine);
  }
}

runs::LoadedScene load_scene(const SceneArguments& arguments, SetUp* set_up) {
  Scene scene = read_file(arguments.path, FileKind::scene, [&] {
    return read_scene(arguments.path, arguments.overrides, arguments.provided);
  });
  apply(arguments.engine, scene);
  if (set_up) set_up->limit(scene.until);
  return runs::complete_scene(std::move(scene));
}

}  // namespace needlework::cli
