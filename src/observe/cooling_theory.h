// Kinetic theory at the times of the samples, so that a plot of both needs one file.
#pragma once

#include <vector>

#include "needlework/theory.h"
#include "src/observe/observable.h"

namespace needlework::observe {

/// The temperatures of a homogeneous gas with Gaussian velocities that starts with these, at the
/// density (see theory_time_scale()) `density`.
ObservablePointer make_cooling_theory(const theory::Gas& gas, theory::Temperatures initial,
                                      double density);

/// The same for a mixture whose species start with these temperatures, and by species.
ObservablePointer make_mixture_theory(const Composition& composition, double volume,
                                      const std::vector<theory::Temperatures>& initial);

}  // namespace needlework::observe
