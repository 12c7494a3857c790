// What the series of a gas of rods of finite width always has.
#pragma once

#include "src/observe/observable.h"

namespace needlework::observe {

/// Packing fraction, virial and pressure.
ObservablePointer make_rod_sums(const Scene& scene, const GasSetting& gas);

}  // namespace needlework::observe
