// Free flight of one needle since its last collision, for any type of numbers.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>

#include "src/audit/ball.h"
#include "src/audit/vector.h"

namespace needlework::audit {

/// The time epoch + offset in units of the engine's epochs; speeds are per epoch. The length of an
/// epoch is a power of two near the mean free time, so nothing is rounded, and no scene comes near
/// overflow or underflow.
struct Instant {
  std::int64_t epoch = 0;
  double offset = 0;
  friend auto operator<=>(const Instant&, const Instant&) = default;
};

template <class Real>
Ball<Real> elapsed(const Instant& from, const Instant& to) {
  const double epochs = static_cast<double>(to.epoch - from.epoch);  // exact
  return Ball<Real>(epochs) + (Ball<Real>(to.offset) - Ball<Real>(from.offset));
}

/// So many epochs after the start.
inline Instant instant_at(double epochs) {
  const double whole = std::floor(epochs);
  return {static_cast<std::int64_t>(whole), epochs - whole};
}

/// So many epochs later, rounded as the engine does it. From 2^62 on times are not followed: the
/// run is older than any.
inline Instant later(const Instant& time, double epochs) {
  constexpr double most_epochs = 0x1p62;
  const double offset = time.offset + (epochs - std::floor(epochs));
  const double carry = std::floor(offset);
  const double whole = std::floor(epochs) + carry;
  if (!(whole + static_cast<double>(time.epoch) < most_epochs)) {
    return {std::numeric_limits<std::int64_t>::max(), 0};
  }
  return {time.epoch + static_cast<std::int64_t>(whole), offset - carry};
}

/// A needle just after its last collision. These numbers are considered exact.
struct Record {
  Instant time;
  Vector<double> r, v, u, w;
};

/// Centre, director and the director's rate of change at one time.
template <class T>
struct Pose {
  Vector<T> r, u, du;
};

/// r(t) = r + v t, u(t) = u cos(omega t) + side sin(omega t). The director is normalised and the
/// angular velocity made normal to it; that of a body without an axis turns no director.
template <class T>
struct Flight {
  Vector<T> r, v, u, side;
  T omega;

  explicit Flight(const Record& record, bool has_axis = true)
      : r(to<T>(record.r)), v(to<T>(record.v)) {
    const Vector<T> given = to<T>(record.u);
    u = given * (T(1) / norm(given));
    const Vector<T> spin = to<T>(record.w);
    const Vector<T> w = spin - u * dot(u, spin);
    const bool spins = has_axis && (record.w[0] != 0 || record.w[1] != 0 || record.w[2] != 0);
    omega = spins ? norm(w) : T(0);
    side = spins ? cross(w, u) * (T(1) / omega) : Vector<T>{{T(0), T(0), T(0)}};
  }

  Pose<T> at(const T& t) const {
    using std::cos, std::sin;
    const T angle = omega * t;
    const T cosine = cos(angle), sine = sin(angle);
    return {r + v * t, u * cosine + side * sine, (side * cosine - u * sine) * omega};
  }
};

}  // namespace needlework::audit
