// Chooses the model that has the effects of a scene compiled in.
#pragma once

#include "src/physics/needle_model.h"

namespace needlework {

/// Calls make.operator()<NeedleModel<...>>() with the model for these effects.
template <class Make>
auto with_model(const Effects& effects, Make&& make) {
  const auto with_table = [&]<bool rough, bool contact_time>() {
    return effects.table
               ? make.template operator()<NeedleModel<Effects{rough, contact_time, true}>>()
               : make.template operator()<NeedleModel<Effects{rough, contact_time, false}>>();
  };
  if (effects.rough) {
    return effects.contact_time ? with_table.template operator()<true, true>()
                                : with_table.template operator()<true, false>();
  }
  return effects.contact_time ? with_table.template operator()<false, true>()
                              : with_table.template operator()<false, false>();
}

}  // namespace needlework
