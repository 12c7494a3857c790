// Sums over classes of needles of one species that are about as large.
#pragma once

#include "src/observe/observable.h"

namespace needlework::observe {

/// So many classes of each species, as by_size.cpp defines them. It is made of a setting that knows
/// all needles by their ids. `follows`: the displacement of each class, too.
ObservablePointer make_by_size(const GasSetting& gas, int classes, bool follows);

}  // namespace needlework::observe
