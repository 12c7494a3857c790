// The motion of two needles relative to each other, for any type of numbers.
#pragma once

#include <array>

#include "src/audit/flight.h"

namespace needlework::audit {

/// r12 at these times after the records, for an image that is `shift` boxes away.
template <class Number>
Vector<Number> separation(const Flight<Number>& first, const Flight<Number>& second,
                          const Number& t1, const Number& t2, const Vector<double>& shift,
                          const std::array<double, 3>& box) {
  Vector<Number> r = first.r - second.r;
  for (int axis = 0; axis < 3; ++axis) r[axis] = r[axis] - Number(shift[axis]) * Number(box[axis]);
  return r + (first.v * t1 - second.v * t2);
}

/// A needle that has fallen for the time `delay` since its record, as one that flies freely: centre
/// and velocity then are those of the parabola. What gravity does from then on, it does to all.
template <class Real>
Flight<Ball<Real>> without_gravity(Flight<Ball<Real>> flight, const Vector<double>& gravity,
                                   const Ball<Real>& delay) {
  for (int axis = 0; axis < 3; ++axis) {
    if (gravity[axis] == 0) continue;
    const Ball<Real> gained = Ball<Real>(gravity[axis]) * delay;
    flight.v[axis] = flight.v[axis] + gained;
    flight.r[axis] = flight.r[axis] - gained * delay * Ball<Real>(0.5);
  }
  return flight;
}

}  // namespace needlework::audit
