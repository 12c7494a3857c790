#include "kernels/rod_pair.h"

#include <cmath>
#include <utility>

#include "kernels/power_of_two.h"

namespace needlework::kernels {
namespace {

// What the rounding of records may move rods by, as a share of the numbers in them, where the pair
// does not say it.
constexpr double rod_record_noise = 0x1p-46;

double size_of(const Vec3d& a) { return std::sqrt(dot(a, a)); }

// Whether the first rod comes first in an order of all that a pair may be made of.
bool is_in_order(const RodPair& pair) {
  const Flight &a = *pair.first, &b = *pair.second;
  if (pair.half_first != pair.half_second) return pair.half_first > pair.half_second;
  if (a.omega != b.omega) return a.omega > b.omega;
  const double rr_a = dot(a.r, a.r), rr_b = dot(b.r, b.r);
  if (rr_a != rr_b) return rr_a > rr_b;
  for (const auto& [p, q] : {std::pair{&a.r, &b.r}, std::pair{&a.v, &b.v}, std::pair{&a.u, &b.u},
                             std::pair{&a.w, &b.w}}) {
    if (p->x != q->x) return p->x > q->x;
    if (p->y != q->y) return p->y > q->y;
    if (p->z != q->z) return p->z > q->z;
  }
  // Records of equal numbers: only their times may differ.
  return !(pair.elapsed_first.hi < pair.elapsed_second.hi);
}

RodPair exchanged(RodPair pair) {
  std::swap(pair.first, pair.second);
  std::swap(pair.elapsed_first, pair.elapsed_second);
  std::swap(pair.half_first, pair.half_second);
  pair.shift = -pair.shift;
  if (pair.fall) pair.fall = Fall{-pair.fall->velocity, -pair.fall->place};
  return pair;
}

}  // namespace

template <class T>
void let_grow(Frame<T>& frame, double growth) {
  frame.growth = growth;
  frame.v = frame.v - frame.r * T(growth);
  // Errors count relative to what the difference is made of, and there are twice as many.
  frame.r_norm *= 2;
  frame.v_norm = (2 * frame.v_norm + growth * frame.r_norm) * roundup;
  frame.v_length = size_of(to_double(frame.v)) * roundup + unit_roundoff<double> * frame.v_norm;
}
template void let_grow(Frame<double>&, double);
template void let_grow(Frame<DoubleDouble>&, double);

PairScale rod_scale_of(const RodPair& pair) {
  const double reach = (pair.half_first + pair.half_second) + pair.distance;
  const double per_length = times_power_of_two(1, -exponent_of(reach));
  // A tip moves by h w and is accelerated by h w^2.
  const auto rate_of = [&](const Flight& rod, double half) {
    return std::sqrt(half * per_length) * rod.omega;
  };
  return scale_of(
      pair, per_length,
      (rate_of(*pair.first, pair.half_first) + rate_of(*pair.second, pair.half_second)) +
          pair.growth);
}

double rod_allowance_of(const RodPair& pair) {
  if (pair.touch_within > 0) return pair.touch_within;
  return rod_record_noise *
         (((size_of(pair.first->r) + size_of(pair.second->r)) + size_of(to_double(pair.shift))) +
          (size_of(pair.first->v) * pair.elapsed_first.hi +
           size_of(pair.second->v) * pair.elapsed_second.hi) +
          ((pair.half_first + pair.half_second) + pair.distance));
}

OrderedRods::OrderedRods(const RodPair& pair) : pair_(&pair) {
  if (!is_in_order(pair)) pair_ = &other_.emplace(exchanged(pair));
}

}  // namespace needlework::kernels
