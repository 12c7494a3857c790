// Chooses the model for the effects of a scene.
#pragma once

#include <stdexcept>

#include "src/physics/needle_model.h"

namespace needlework {

/// Calls make.operator()<M>() with the first model that covers these effects. Throws
/// std::logic_error if there is none, rather than leave an effect out: a scene that asks for such a
/// combination is not valid (src/scene/validity.h), and should not have come so far.
template <class Make>
auto with_model(const Effects& effects, Make&& make) {
  if (NeedleModel<false>::covers(effects)) return make.template operator()<NeedleModel<false>>();
  if (NeedleModel<true>::covers(effects)) return make.template operator()<NeedleModel<true>>();
  if (RodModel::covers(effects)) return make.template operator()<RodModel>();
  if (SphereModel::covers(effects)) return make.template operator()<SphereModel>();
  if (MixedModel::covers(effects)) return make.template operator()<MixedModel>();
  if (SlidingModel::covers(effects)) return make.template operator()<SlidingModel>();
  throw std::logic_error("no model has all effects that this scene asks for together");
}

}  // namespace needlework
