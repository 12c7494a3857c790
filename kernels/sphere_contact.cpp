#include "kernels/sphere_contact.h"

#include <cmath>

namespace needlework::kernels {
namespace {

// Numbers whose squares, and products of these, are exact but for roundoff.
bool is_moderate(double square) { return square > 0x1p-240 && square < 0x1p240; }

struct Spheres {
  Vec3d r, v;      // of the first less those of the second, at s = 0
  double contact;  // square of the distance at contact
  double vv;

  explicit Spheres(const RodPair& pair)
      : r(to_double(separation(pair))),
        v(pair.fall ? to_double(falling_velocity(pair)) : pair.first->v - pair.second->v),
        contact(pair.distance * pair.distance),
        vv(dot(v, v)) {}
  bool are_moderate() const {
    return is_moderate(contact) && is_moderate(vv) && dot(r, r) < 0x1p240;
  }
};

}  // namespace

std::optional<Contact> sphere_contact(const RodPair& pair, double until,
                                      EvaluationCounters& counters) {
  const Spheres spheres(pair);
  if (!spheres.are_moderate()) return std::nullopt;
  const auto& [r, v, contact, vv] = spheres;
  const double rr = dot(r, r), size = rr + contact, excess = rr - contact;
  // The places are rounded once, as are their squares, sums and that of the distance.
  const double of_contact = unit_roundoff<double> * contact;
  const double error = 6 * unit_roundoff<double> * rr + of_contact;
  const double rv = dot(r, v);
  // Mostly a pair that has just collided.
  if (rv > 0 && excess > -pair.distance * pair.touch_within) return Contact{};
  if (!(excess > error)) return std::nullopt;
  if (!(rv < 0)) return Contact{};
  ++counters.evaluated;
  const Vec3d n = cross(r, v);
  const double d = contact * vv - dot(n, n);
  const double error_d = (16 * unit_roundoff<double> * size + of_contact) * vv;
  if (!(d > -error_d)) return Contact{};
  const bool is_known = error <= rod_polish_above * excess && error_d <= rod_polish_above * d;
  if (!is_known) return std::nullopt;
  const double s = excess / (std::sqrt(d) - rv);
  if (s > until) return Contact{};
  // Whether it is a return by rounding.
  if (pair.touch.collided) return std::nullopt;
  return Contact{.found = true, .elapsed = s, .side = 1};
}

std::optional<ContactGeometry> sphere_geometry(const RodPair& pair, const DoubleDouble& elapsed) {
  // Shorter normals would have lost digits.
  const Spheres spheres(pair);
  if (!spheres.are_moderate()) return std::nullopt;
  ContactGeometry out;
  out.u_first = pair.first->u;
  out.u_second = pair.second->u;
  const Vec3d x = cross(out.u_first, out.u_second);
  out.sin_angle = std::sqrt(dot(x, x));
  const Vec3d gap = spheres.r + spheres.v * elapsed.hi;
  const double length = std::sqrt(dot(gap, gap));
  out.normal = {gap.x / length, gap.y / length, gap.z / length};
  return out;
}

std::optional<double> sphere_time_apart(const RodPair& pair) {
  const Spheres spheres(pair);
  if (!spheres.are_moderate() || !(dot(spheres.r, spheres.v) > 0)) return std::nullopt;
  // They fly apart. A time for which all numbers stay finite.
  return 0x1p20 * std::sqrt(spheres.contact / spheres.vv);
}

}  // namespace needlework::kernels
