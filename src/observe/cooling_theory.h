// Kinetic theory at the times of the samples, so that a plot of both needs one file.
#pragma once

#include "needlework/theory.h"
#include "src/observe/observable.h"

namespace needlework::observe {

/// The temperatures of a homogeneous gas with Gaussian velocities that starts with these, at the
/// density (see theory_time_scale()) `density`.
ObservablePointer make_cooling_theory(const theory::Gas& gas, theory::Temperatures initial,
                                      double density);

}  // namespace needlework::observe
