// Chooses the model for the effects of a scene.
#pragma once

#include "src/physics/needle_model.h"

namespace needlework {

/// Calls make.operator()<M>() with the model for these effects.
template <class Make>
auto with_model(const Effects& effects, Make&& make) {
  if (effects.width) return make.template operator()<RodModel>();
  if (effects.sliding) return make.template operator()<SlidingModel>();
  return effects.any() ? make.template operator()<NeedleModel<true>>()
                       : make.template operator()<NeedleModel<false>>();
}

}  // namespace needlework
