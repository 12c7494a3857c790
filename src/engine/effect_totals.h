// Which effects a run has, and what each has done: what Simulation says of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "needlework/totals.h"
#include "src/engine/run.h"

namespace needlework {

/// In words, one after the other, of which the first is "elastic" or "inelastic".
std::string name_effects(const Run& run);

/// Of each pair of species, in the order of Composition::pair_index().
std::vector<std::uint64_t> collisions_by_pair(const Run& run);
/// Of each object of each source of events, such as each wall.
std::vector<std::vector<ObjectTotals>> objects_by_source(const Run& run);
std::vector<WallTotals> wall_totals(const Run& run, const Scene& scene);
/// None where needles do not slide.
std::optional<SlidingContacts> sliding_contacts(const Run& run);
/// Present sizes of bodies in those of the scene, which a restart has to all digits at its start.
double present_scale(const Run& run, const Scene& scene, const Composition& at_start);
/// None where bodies do not grow; `at_start` is what they were before.
std::optional<GrowthTotals> growth_totals(const Run& run, const Scene& scene,
                                          const Composition& at_start);

}  // namespace needlework
