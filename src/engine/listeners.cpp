#include "src/engine/listeners.h"

#include "src/physics/vectors.h"

namespace needlework {

void Listeners::report(const Gas& gas, Happening& what, Needle a, Needle b, Reports* later) const {
  if (times && what.is_collision()) {
    if (later) {
      later->times.push_back(what.event.time);
    } else {
      times({&what.event.time, 1});
    }
  }
  if (!happening && !(collision && what.is_collision())) return;
  const auto state_of = [&](Needle i) {
    const kernels::Flight& flight = gas.records[i].flight;
    return StateAfterCollision{to_array(flight.r), to_array(flight.v), to_array(flight.u),
                               to_array(flight.w)};
  };
  what.event.after[0] = state_of(a);
  if (b != no_needle) what.event.after[1] = state_of(b);
  if (later) {
    later->happenings.push_back(what);
  } else {
    pass_on(what);
  }
}

void Listeners::pass_on(const Happening& what) const {
  if (collision && what.is_collision()) collision(what.event);
  if (happening) happening(what);
}

}  // namespace needlework
