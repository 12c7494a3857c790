// Pairs in the form that kernels use, held by value, and transformations that preserve their
// contacts.
#pragma once

#include <cmath>
#include <utility>

#include "kernels/contact_function.h"
#include "src/physics/director.h"
#include "tests/support/pair_families.h"
#include "tests/support/vector.h"

namespace needlework::test {

struct KernelPair {
  kernels::Flight first, second;
  DoubleDouble elapsed_first, elapsed_second;
  Vec3dd shift;
  kernels::Touch touch;
  double touch_within = 0;
  double half_first = 0.5, half_second = 0.5;

  /// A view of this pair, which must outlive it.
  kernels::Pair view() const {
    return {.first = &first,
            .second = &second,
            .elapsed_first = elapsed_first,
            .elapsed_second = elapsed_second,
            .shift = shift,
            .half_first = half_first,
            .half_second = half_second,
            .touch = touch,
            .touch_within = touch_within};
  }
};

inline Vec3d vec3(const Vec<double>& a) { return {a[0], a[1], a[2]}; }

/// A record with normalised director, and with angular velocity normal to it.
inline kernels::Flight flight(const Vec3d& r, const Vec3d& u, const Vec3d& v, const Vec3d& w) {
  kernels::Flight out;
  out.r = r;
  out.u = normalised(u);
  out.v = v;
  out.w = project_out(w, out.u);
  set_rotation(out);
  return out;
}

inline kernels::Flight flight(const FreeNeedle& needle) {
  return flight(vec3(needle.position), vec3(needle.orientation), vec3(needle.velocity),
                vec3(needle.angular_velocity));
}

inline KernelPair kernel_pair(const NeedlePair& pair) {
  KernelPair out;
  out.first = flight(pair.first);
  out.second = flight(pair.second);
  return out;
}

inline double power_of_two(double a, int power) { return std::ldexp(a, power); }
inline DoubleDouble power_of_two(const DoubleDouble& a, int power) {
  return {std::ldexp(a.hi, power), std::ldexp(a.lo, power)};
}

/// The contact function is unchanged.
inline KernelPair exchanged(KernelPair pair) {
  std::swap(pair.first, pair.second);
  std::swap(pair.elapsed_first, pair.elapsed_second);
  std::swap(pair.half_first, pair.half_second);
  pair.shift = -pair.shift;
  return pair;
}

/// The mirror image in the plane x = y: the contact function changes its sign.
inline KernelPair axes_swapped(KernelPair pair) {
  for (kernels::Flight* needle : {&pair.first, &pair.second}) {
    std::swap(needle->r.x, needle->r.y);
    std::swap(needle->u.x, needle->u.y);
    std::swap(needle->v.x, needle->v.y);
    needle->w = {-needle->w.y, -needle->w.x, -needle->w.z};
    set_rotation(*needle);
  }
  std::swap(pair.shift.x, pair.shift.y);
  pair.touch.side = -pair.touch.side;
  pair.touch.gap = -pair.touch.gap;
  return pair;
}

/// Velocities times 2^-power, times times 2^power.
inline KernelPair slowed(KernelPair pair, int power) {
  for (kernels::Flight* needle : {&pair.first, &pair.second}) {
    for (Vec3d* a : {&needle->v, &needle->w}) {
      *a = {std::ldexp(a->x, -power), std::ldexp(a->y, -power), std::ldexp(a->z, -power)};
    }
    set_rotation(*needle);
  }
  pair.elapsed_first = power_of_two(pair.elapsed_first, power);
  pair.elapsed_second = power_of_two(pair.elapsed_second, power);
  return pair;
}

/// Lengths times `factor`, times as they are; exact for powers of two.
inline KernelPair lengthened(KernelPair pair, double factor) {
  for (kernels::Flight* needle : {&pair.first, &pair.second}) {
    needle->r = needle->r * factor;
    needle->v = needle->v * factor;
  }
  const auto longer = [&](const DoubleDouble& a) {
    return DoubleDouble(a.hi * factor, a.lo * factor);
  };
  pair.shift = {longer(pair.shift.x), longer(pair.shift.y), longer(pair.shift.z)};
  pair.touch.gap *= factor;
  pair.touch_within *= factor;
  pair.half_first *= factor;
  pair.half_second *= factor;
  return pair;
}

/// Lengths times 2^power.
inline KernelPair resized(const KernelPair& pair, int power) {
  return lengthened(pair, std::ldexp(1.0, power));
}

}  // namespace needlework::test
