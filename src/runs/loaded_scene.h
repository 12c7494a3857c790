// A scene that is ready to run: its engine is chosen, and its initial state read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"
#include "needlework/theory.h"
#include "needlework/totals.h"
#include "src/scene/own_bodies.h"

namespace needlework::runs {

/// A scene that is complete: where its initial state comes from a file, that is read, and count,
/// box and bodies are filled in from it.
struct LoadedScene {
  Scene scene;
  std::optional<State> initial;  ///< none: to be drawn
};

/// Chooses the engine as choose_engine() does, and reads the initial state if it is in a file.
/// Throws InputError for an engine that is not on offer, for a state that does not fit, and for
/// more needles than the memory of this machine can hold; IoError for a file that cannot be read.
LoadedScene complete_scene(Scene given);
/// The same for a scene that starts from this state, of which count, box and bodies are
/// filled in.
LoadedScene complete_scene(Scene given, State initial);

/// A warning if the state is from a file that does not say all of its bodies, and neither does the
/// scene; or if it says no flow, but drifts along that of the scene; else empty.
std::string warning_of_state(const LoadedScene& loaded);

/// Velocities beside the flow of [shear], where there is one [L / time].
std::vector<std::array<double, 3>> peculiar_velocities(const State& state, const Scene& scene);

/// Its needles: those of the state in its order, or those to be drawn in order of id.
Members members_of(const LoadedScene& loaded);

/// The state's sums at time 0, of the needles that move.
Totals totals_of(const State& state, const Scene& scene);

/// Those that are drawn, or those of the state that is given, of the needles that move.
theory::Temperatures initial_temperatures(const LoadedScene& loaded);

/// The same for each species: 0 of a fixed one. Those of one without needles are not numbers.
std::vector<theory::Temperatures> temperatures_by_species(const LoadedScene& loaded);

/// Whether kinetic theory follows this mixture: it has not too many species.
bool has_mixture_theory(const Composition& composition);

/// What a composition has that the theory of cooling does not follow, which says nothing then; else
/// null. Rates at one instant are known all the same.
const char* beyond_cooling_theory(const Composition& composition);

double volume_of(const Scene& scene);  ///< of the box [L^3]
/// Needles per volume of the box, in cubes of the length of the longest [1].
double density_of(const Scene& scene);
/// The density at which needles of length 1 and mass 1 collide as often at equal temperatures,
/// n L^2 / sqrt(m) by the means of the first species: the one to use in the theory, which knows
/// only those. [1 / time]
double theory_density_of(const Scene& scene);

}  // namespace needlework::runs
