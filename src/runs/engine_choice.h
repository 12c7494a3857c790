// Which of the engine's parts a scene asks for, and whether they are there.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "src/runs/loaded_scene.h"
#include "src/scene/engine_parts.h"

namespace needlework::runs {

using needlework::instruction_sets;
using needlework::is_for_threads;

/// Completes the scene's choice from the environment and checks that threads and instruction set
/// are on offer. NEEDLEWORK_ISA counts where the scene says auto. OMP_NUM_THREADS is a wish for at
/// most so many threads, where the scene does not say how many; a search or calendar for one thread
/// takes one. Where threads are chosen by size, needles.count has to be known. Throws InputError
/// naming the value, where it was set, and what is available.
void choose_engine(Scene& scene);

/// How many threads `engine.threads = "auto"` takes: one for each core that the process may use, at
/// most as many as OMP_NUM_THREADS says, and only as many as have enough needles each.
int threads_by_size(std::size_t needles);

/// The number of threads, and what it follows from if the engine has chosen it.
std::string threads_text(const Scene& scene);

/// The warnings of check.h, one of a contact time that is long beside the initial mean free time,
/// and one if there are more threads than cores.
std::vector<std::string> all_warnings(const LoadedScene& loaded);

/// Cores that the process may use; see src/machine/available_cores.h.
int cores();

/// How many runs go on at once by default: as many as OMP_NUM_THREADS says, else one for each core.
int threads_on_offer();

/// The name that `auto` stands for.
std::string resolved_isa(const Scene::Engine& engine);

}  // namespace needlework::runs
