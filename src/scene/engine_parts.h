// Which parts of the engine go with several threads, and which instruction sets there are.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/scene.h"

namespace needlework {

/// The values of engine.search and engine.queue, besides "auto", that several threads can use.
inline constexpr std::array<std::string_view, 2> parallel_searches = {"linked-cells", "capsules"};
inline constexpr std::array<std::string_view, 1> parallel_calendars = {"cell-calendar"};

/// Whether search and queue are for several threads.
bool is_for_threads(const Scene::Engine& engine);

/// Instruction sets that this processor has, by the names of engine.isa; the last is the widest.
std::vector<std::string> instruction_sets();

}  // namespace needlework
