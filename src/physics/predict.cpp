#include "src/physics/predict.h"

#include <cmath>
#include <limits>
#include <string>

#include "kernels/first_contact.h"
#include "src/error.h"
#include "src/physics/director.h"

namespace needlework {
namespace {

// Squares of places must not overflow; velocities are scaled first.
constexpr double farthest = 1e150;

Vec3d read(const std::array<double, 3>& a, const char* what,
           double most = std::numeric_limits<double>::max()) {
  for (double x : a) {
    if (!std::isfinite(x)) {
      throw InputError(std::string(what) + " = " + std::to_string(x) + ": expected finite numbers");
    }
    if (!(std::abs(x) <= most)) {
      throw InputError(std::string(what) + ": expected at most 1e150 in magnitude");
    }
  }
  return {a[0], a[1], a[2]};
}

kernels::Flight flight_of(const FreeNeedle& needle) {
  kernels::Flight out;
  out.r = read(needle.position, "position", farthest);
  out.v = read(needle.velocity, "velocity");
  const Vec3d u = read(needle.orientation, "orientation");
  const Vec3d w = read(needle.angular_velocity, "angular velocity");
  if (u == Vec3d{}) throw InputError("orientation = 0: expected a direction");
  out.u = normalised(u);
  out.w = project_out(w, out.u);
  set_rotation(out);
  return out;
}

}  // namespace

FirstContact predict(const FreeNeedle& first, const FreeNeedle& second, double horizon,
                     bool just_collided, const Accuracy& accuracy) {
  const kernels::Flight a = flight_of(first), b = flight_of(second);
  kernels::Pair pair;
  pair.first = &a;
  pair.second = &b;
  kernels::SearchCounters counters;
  if (just_collided) {
    const int side = kernels::side_after(pair);
    pair.touch = {.touching = side != 0, .collided = true, .side = side, .gap = 0};
  }
  const kernels::Contact contact = kernels::first_contact(pair, 0, horizon, counters, accuracy);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  FirstContact out{std::numeric_limits<double>::infinity(), nan, nan, 0, 0};
  if (contact.found) {
    const kernels::ContactGeometry geometry = contact_geometry(pair, contact.elapsed);
    out.time = contact.elapsed.hi;
    out.arm_first = geometry.arm_first;
    out.arm_second = geometry.arm_second;
  }
  out.evaluations = counters.evaluated;
  out.escalations = counters.escalated;
  return out;
}

}  // namespace needlework
