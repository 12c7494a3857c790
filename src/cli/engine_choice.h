// Which of the engine's parts a scene asks for, and whether they are there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/scene/scene.h"

namespace needlework::cli {

/// Flags that take the place of keys in [engine].
struct EngineFlags {
  std::optional<int> threads;
  std::optional<std::string> isa;
};

/// Instruction sets on offer on this CPU, by the names of `--isa`, the narrowest first.
std::vector<std::string> instruction_sets();

/// Puts flags, then the environment (NEEDLEWORK_ISA where the scene says auto), into the scene and
/// checks that search, queue, threads and ISA are on offer. OMP_NUM_THREADS is a wish for
/// at most so many threads; as the engine has one thread, every value of it is met by 1.
/// Throws InputError naming the value, where it was set, and what is available.
void choose_engine(Scene& scene, const EngineFlags& flags);

/// The names that `auto` stands for.
std::string resolved_search(const Scene::Engine& engine, double density);
std::string resolved_queue(const Scene::Engine& engine);
std::string resolved_isa(const Scene::Engine& engine);

}  // namespace needlework::cli
