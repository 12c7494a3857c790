// What the series of a gas of rods of finite width always has.
#pragma once

#include "src/observe/observable.h"

namespace needlework::observe {

/// Packing fraction, virial and pressure by collisions.
ObservablePointer make_rod_sums(const GasSetting& gas);

}  // namespace needlework::observe
