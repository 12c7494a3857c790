// The kernel of free_flight.h. Included in the namespace of each instruction
// set, which has Doubles and turned().

#include "kernels/sine_cosine_body.h"

inline void fly(const FlightColumns& needles, std::size_t n) {
  using C = FlightColumns;
  for (std::size_t k = 0; k < n; k += doubles_at_once) {
    const auto load = [&](int c) NEEDLEWORK_TARGET { return load_doubles(needles.column[c] + k); };
    const Doubles elapsed = load(C::elapsed);
    const SineCosine<Doubles> sc = sine_cosine_of(load(C::omega) * elapsed);
    for (int axis = 0; axis < 3; ++axis) {
      const Doubles r = load(C::r_x + axis) + load(C::v_x + axis) * elapsed;
      const Doubles u = load(C::u_x + axis) * sc.cosine + load(C::p_x + axis) * sc.sine;
      store_doubles(r, needles.column[C::r_x + axis] + k);
      store_doubles(u, needles.column[C::u_x + axis] + k);
    }
  }
}
