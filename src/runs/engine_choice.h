// Which of the engine's parts a scene asks for, and whether they are there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "needlework/scene.h"

namespace needlework::cli {

/// Flags that take the place of keys in [engine].
struct EngineFlags {
  std::optional<int> threads;
  std::optional<std::string> isa;
};

/// Instruction sets on offer on this CPU, by the names of `--isa`, the narrowest first.
std::vector<std::string> instruction_sets();

/// Puts flags, then the environment (NEEDLEWORK_ISA where the scene says auto), into the scene and
/// checks that threads and instruction set are on offer. OMP_NUM_THREADS is a wish for at most so
/// many threads, where the scene does not say how many; a search or queue for one thread takes one.
/// Throws InputError naming the value, where it was set, and what is available.
void choose_engine(Scene& scene, const EngineFlags& flags);

/// The name that `auto` stands for.
std::string resolved_isa(const Scene::Engine& engine);

}  // namespace needlework::cli
