#include "needlework/predict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "needlework/error.h"
#include "src/physics/contact.h"
#include "src/physics/director.h"

namespace needlework {
namespace {

// Squares of positions must not overflow, and neither must differences of velocities, which are
// scaled before they are squared.
constexpr double farthest = 1e150, fastest = 1e300;

// Needles may turn near each other for ever and never touch. A search is given up when it has taken
// this much work, about a second: an evaluation of the contact function in double is 1, and so is a
// unit of the pair's own time, as stretches without any take time too.
constexpr double most_work = 0x1p22;
// Time between looks at the work, in the pair's own unit.
constexpr double stretch = 0x1p4;
// In that unit, too. Times in double are farther apart later on than the intervals of the search.
constexpr double latest = 0x1p50;

void require_in_range(const Accuracy& accuracy) {
  const double tolerance = accuracy.root_tolerance, step = accuracy.sampling_step;
  if (!(tolerance >= 0 && tolerance <= 1e-3)) {
    throw InputError(
        fmt::format("root_tolerance = {:g}: expected a number from 0 to 1e-3", tolerance));
  }
  if (!(step >= 1e-4 && step <= 0.5)) {
    throw InputError(fmt::format("sampling_step = {:g}: expected a number from 1e-4 to 0.5", step));
  }
}

Vec3d read(const std::array<double, 3>& a, const char* what, double most) {
  for (double x : a) {
    if (!(std::abs(x) <= most)) {
      throw InputError(fmt::format("{} component = {:g}: expected a number of at most {:g} in size",
                                   what, x, most));
    }
  }
  return {a[0], a[1], a[2]};
}

double half_length_of(const FreeNeedle& needle) {
  const bool is_sphere = needle.length == 0 && needle.diameter > 0;
  if (is_sphere || (needle.length >= 1 / farthest && needle.length <= farthest))
    return 0.5 * needle.length;
  throw InputError(fmt::format("length = {:g}: expected a number from {:g} to {:g}{}",
                               needle.length, 1 / farthest, farthest,
                               needle.length == 0 ? ", or a diameter, of a sphere" : ""));
}

double diameter_of(const FreeNeedle& needle) {
  const double diameter = needle.diameter;
  if (diameter == 0 || (diameter >= 1 / farthest && diameter <= farthest)) return diameter;
  throw InputError(fmt::format("diameter = {:g}: expected 0, or a number from {:g} to {:g}",
                               diameter, 1 / farthest, farthest));
}

kernels::Flight flight_of(const FreeNeedle& needle) {
  kernels::Flight out;
  out.r = read(needle.position, "position", farthest);
  out.v = read(needle.velocity, "velocity", fastest);
  const Vec3d u = read(needle.orientation, "orientation", std::numeric_limits<double>::max());
  const Vec3d w = read(needle.angular_velocity, "angular velocity", fastest);
  if (u == Vec3d{}) throw InputError("orientation = 0: expected a direction");
  out.u = normalised(u);
  out.w = project_out(w, out.u);
  set_rotation(out);
  return out;
}

// The times >= 0 between which the bounding spheres overlap, with a margin for rounding; infinite
// if they never do.
struct NearInterval {
  double enter, exit;
};
NearInterval near_interval(const kernels::Pair& pair, double distance) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Vec3d r = pair.first->r - pair.second->r, v = pair.first->v - pair.second->v;
  const double reach = (pair.half_first + pair.half_second + distance) * (1 + 0x1p-20) +
                       0x1p-46 * (std::abs(r.x) + std::abs(r.y) + std::abs(r.z));
  const double scale = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (scale == 0) return {dot(r, r) <= reach * reach ? 0 : infinity, infinity};
  const Vec3d d = v * (1 / scale);
  const double dd = dot(d, d), nearest = -dot(r, d) / dd;
  const Vec3d gap = r + d * nearest;
  const double left = reach * reach - dot(gap, gap);
  if (!(left >= 0)) return {infinity, infinity};
  const double half = std::sqrt(left / dd);
  return {std::max(0.0, nearest - half) / scale, std::max(0.0, nearest + half) / scale};
}

// The first contact in (0, horizon]. How long the search takes does not depend on the length of
// time alone, so that it goes on stretch by stretch.
template <ContactLaw Law>
kernels::Contact search(const Law& law, const typename Law::Pair& pair, double distance,
                        const kernels::PairScale& scale, double horizon,
                        kernels::EvaluationCounters& counters) {
  const NearInterval near = near_interval(pair, distance);
  const double last = std::min(horizon, near.exit);
  if (std::isinf(near.enter)) return {};
  if (!scale.moves) {  // so that they overlap now or never
    return Law::never_overlap ? law.first_contact(pair, 0, 0, counters) : kernels::Contact{};
  }
  for (double begin = near.enter; begin <= last;) {
    if (begin * scale.per_time > latest) {
      throw InputError(
          fmt::format("no contact by time {:g}, after which the times that a double can hold are "
                      "too far apart: expected needles that come near each other before",
                      begin));
    }
    const double end = begin + stretch * scale.per_rate;
    const auto contact = law.first_contact(pair, begin, std::min(last, end), counters);
    if (!counters.is_spent() && (contact.found || end >= last)) return contact;
    const double work = (end - near.enter) * scale.per_time + static_cast<double>(counters.work());
    if (work > most_work || counters.is_spent()) {
      throw InputError(fmt::format(
          "no contact by time {:g}, after {} steps of the search and {:.3g} radians that the "
          "needles have turned near each other: expected a horizon that ends before",
          counters.is_spent() ? begin : end, counters.evaluated + counters.escalated,
          (end - near.enter) * (pair.first->omega + pair.second->omega)));
    }
    begin = end;
  }
  return {};
}

template <ContactLaw Law>
FirstContact predicted(const Law& law, typename Law::Pair& pair, double distance,
                       const kernels::PairScale& scale, double horizon, bool just_collided) {
  kernels::EvaluationCounters counters{.most_work = static_cast<std::uint64_t>(most_work)};
  if (just_collided) {
    const int side = law.side_after(pair);
    pair.touch = {.touching = side != 0, .collided = true, .side = side, .gap = 0};
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  FirstContact out{infinity, nan, nan, 0, 0};
  const kernels::Contact contact = search(law, pair, distance, scale, horizon, counters);
  if (contact.overlap) {
    throw InputError(
        fmt::format("the rods overlap: their axes are {:.10g} apart, less than {:.10g}",
                    distance + law.gap(pair, DoubleDouble()), distance));
  }
  if (contact.found) {
    const kernels::ContactGeometry geometry = law.geometry(pair, contact.elapsed);
    out.time = contact.elapsed.hi;
    out.arm_first = geometry.arm_first;
    out.arm_second = geometry.arm_second;
  }
  out.evaluations = counters.evaluated;
  out.escalations = counters.escalated;
  return out;
}

}  // namespace

FirstContact predict(const FreeNeedle& first, const FreeNeedle& second, double horizon,
                     bool just_collided, const Accuracy& accuracy) {
  if (!(horizon >= 0)) {
    throw InputError(fmt::format("horizon = {:g}: expected a time, 0 or later", horizon));
  }
  require_in_range(accuracy);
  kernels::Flight a = flight_of(first), b = flight_of(second);
  kernels::RodPair pair;
  pair.first = &a;
  pair.second = &b;
  pair.half_first = half_length_of(first);
  pair.half_second = half_length_of(second);
  const double width_a = diameter_of(first), width_b = diameter_of(second);
  if (width_a == 0 && width_b == 0)
    return predicted<NeedleContact>(NeedleContact(accuracy), pair, 0, scale_of(pair), horizon,
                                    just_collided);
  for (const auto& [flight, half] : {std::pair(&a, pair.half_first), {&b, pair.half_second}}) {
    if (half > 0) continue;
    flight->w = {};  // of a sphere, whose director marks nothing
    set_rotation(*flight);
  }
  pair.distance = 0.5 * (width_a + width_b);
  return predicted<RodContact>(RodContact(accuracy), pair, pair.distance, rod_scale_of(pair),
                               horizon, just_collided);
}

}  // namespace needlework
