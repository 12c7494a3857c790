#include "kernels/sphere_contact.h"

#include <cmath>
#include <optional>
#include <type_traits>

#include "kernels/rod_instants.h"

namespace needlework::kernels {
namespace {

// Numbers whose squares, and products of these, are exact but for roundoff.
bool is_moderate(double square) { return square > 0x1p-240 && square < 0x1p240; }

struct Spheres {
  Vec3d r, v;      // of the first less those of the second, at s = 0; comoving (kernels/rod_pair.h)
  double contact;  // square of the distance at contact
  double vv;

  explicit Spheres(const RodPair& pair)
      : r(to_double(separation(pair))),
        v(pair.fall ? to_double(falling_velocity(pair)) : pair.first->v - pair.second->v),
        contact(pair.distance * pair.distance),
        vv(dot(v, v)) {
    if (pair.growth > 0) [[unlikely]]
      let_grow(pair.growth);
  }
  [[gnu::noinline]] void let_grow(double growth) {
    v = v - r * growth;
    vv = dot(v, v);
  }
  bool are_moderate() const {
    return is_moderate(contact) && is_moderate(vv) && dot(r, r) < 0x1p240;
  }
};

// Where comoving time is nearer to its end than this share, double loses digits of the time.
constexpr double least_left = 0x1p-6;

// Bound on the error of the discriminant: the comoving velocity is rounded more often, and by a
// share of what it is the difference of.
[[gnu::noinline]] double error_where_growing(const RodPair& pair, double size, double of_contact,
                                             double rr) {
  const Vec3d v = pair.fall ? to_double(falling_velocity(pair)) : pair.first->v - pair.second->v;
  const double size_vv = 8 * (dot(v, v) + pair.growth * pair.growth * rr);
  return (16 * unit_roundoff<double> * size + of_contact) * size_vv;
}

// Nothing where they touch at s = 0, where rounding might decide, or where squares of their numbers
// might overflow or lose digits.
std::optional<Contact> quick_contact(const RodPair& pair, double until,
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
  double error_d = (16 * unit_roundoff<double> * size + of_contact) * vv;
  if (pair.growth > 0) [[unlikely]]
    error_d = error_where_growing(pair, size, of_contact, rr);
  if (!(d > -error_d)) return Contact{};
  const bool is_known = error <= rod_polish_above * excess && error_d <= rod_polish_above * d;
  if (!is_known) return std::nullopt;
  double s = excess / (std::sqrt(d) - rv);
  if (pair.growth > 0) [[unlikely]] {
    const double left = 1 - pair.growth * s;
    if (!(left > 0)) return Contact{};
    if (left < least_left) return std::nullopt;
    s /= left;
  }
  if (s > until) return Contact{};
  // Whether it is a return by rounding.
  if (pair.touch.collided) return std::nullopt;
  return Contact{.found = true, .elapsed = s, .side = 1};
}

// The same with all that rounding might decide, in an order of the two that is not that of the
// caller.
class SphereSearch {
 public:
  SphereSearch(const RodPair& pair, const Accuracy& accuracy, EvaluationCounters& counters)
      : accuracy_(accuracy), counters_(counters), spheres_(pair, counters) {}
  Contact run(double until);

 private:
  template <class T>
  bool solve(std::optional<DoubleDouble>& root);

  const Accuracy& accuracy_;
  EvaluationCounters& counters_;
  RodInstants spheres_;
};

// The first root of |r + v s|^2 = distance^2, for spheres that approach; whether its error and that
// of the decision that there is one are bounded well enough.
template <class T>
bool SphereSearch::solve(std::optional<DoubleDouble>& root) {
  using std::sqrt;
  constexpr bool is_double = std::is_same_v<T, double>;
  ++(is_double ? counters_.evaluated : counters_.escalated);
  const Frame<T>& frame = spheres_.frame<T>();
  const Vec3<T>&r = frame.r, &v = frame.v, n = cross(r, v);
  const T contact = spheres_.threshold<T>(), vv = dot(v, v);
  const T excess = dot(r, r) - contact, d = contact * vv - dot(n, n);
  const double rr = to_double(dot(r, r)), size = rr + to_double(contact);
  const double of_contact = is_double ? spheres_.threshold_error() : unit_roundoff<T> * size;
  const double error = 6 * unit_roundoff<T> * rr + of_contact;
  const bool grows = frame.growth > 0;
  const double size_vv = grows ? 8 * frame.v_norm * frame.v_norm : to_double(vv);
  const double error_d = (16 * unit_roundoff<T> * size + of_contact) * size_vv;
  // What double-double does not tell from a touch is one.
  if (!(to_double(d) > (is_double ? -error_d : error_d))) return true;
  const T s = excess / (sqrt(d) - dot(r, v));
  root = DoubleDouble(time_of_comoving(frame, s));
  if (is_double && grows && !(frame.growth * to_double(s) <= 1 - least_left)) return false;
  return error <= rod_polish_above * to_double(excess) &&
         error_d <= rod_polish_above * to_double(d);
}

Contact SphereSearch::run(double until) {
  const Frame<double>& frame = spheres_.frame<double>();
  const double end = until * spheres_.scale().per_time;
  const double rr = dot(frame.r, frame.r);
  const double error = 16 * unit_roundoff<double> * (rr + spheres_.threshold<double>());
  if (!(rr - spheres_.threshold<double>() > error)) {
    const Instant<double> start = spheres_.at(0.0);
    spheres_.begin(start);
    if (spheres_.are_touching() && spheres_.overlaps(start)) return overlap_found();
    if (spheres_.are_touching() && start.rate < 0) {
      const Instant<DoubleDouble> fine = spheres_.at(DoubleDouble());
      if (!(fine.excess > fine.error)) {
        // They fly along a line, so that a velocity which is rounding takes them no deeper.
        if (!(fine.rate < -spheres_.noise_of_rate(start))) return {};
        return {.found = true, .elapsed = {}, .side = 1};
      }
    }
  }
  if (!(dot(frame.r, frame.v) < 0)) return {};
  std::optional<DoubleDouble> root;
  const bool always = accuracy_.escalation == Escalation::always;
  if (always || !solve<double>(root)) {
    root.reset();
    solve<DoubleDouble>(root);
  }
  return root ? contact_at(spheres_, *root, end) : Contact{};
}

// Spheres that fly apart do not meet again; a time for which all numbers stay finite.
constexpr double time_of_spheres = 0x1p20;

}  // namespace

Contact sphere_contact(const RodPair& pair, double until, EvaluationCounters& counters,
                       const Accuracy& accuracy) {
  if (accuracy.escalation != Escalation::always) {
    if (const auto contact = quick_contact(pair, until, counters)) return *contact;
  }
  const OrderedRods ordered(pair);
  return SphereSearch(ordered.pair(), accuracy, counters).run(until);
}

ContactGeometry sphere_geometry(const RodPair& pair, const DoubleDouble& elapsed) {
  ContactGeometry out;
  out.u_first = pair.first->u;
  out.u_second = pair.second->u;
  const Vec3d x = cross(out.u_first, out.u_second);
  out.sin_angle = std::sqrt(dot(x, x));
  const Spheres spheres(pair);
  Vec3d gap = spheres.r + spheres.v * (elapsed.hi / (1 + pair.growth * elapsed.hi));
  if (!spheres.are_moderate()) {
    // Shorter or longer normals would lose digits.
    const PairScale scale = rod_scale_of(pair);
    const Frame<double> frame = rod_frame<double>(pair, scale);
    const double s = elapsed.hi * scale.per_time;
    gap = (pair.growth > 0 ? centres_at<true>(frame, s) : centres_at<false>(frame, s)).r;
  }
  const double length = std::sqrt(dot(gap, gap));
  out.normal = {gap.x / length, gap.y / length, gap.z / length};
  return out;
}

double sphere_time_apart(const RodPair& pair) {
  const Spheres spheres(pair);
  if (spheres.are_moderate() && dot(spheres.r, spheres.v) > 0)
    return time_of_spheres * std::sqrt(spheres.contact / spheres.vv);
  EvaluationCounters ignored;
  const OrderedRods ordered(pair);
  RodInstants exact(ordered.pair(), ignored);
  const bool part = exact.scale().moves && exact.at(0.0).rate > 0;
  return part ? time_of_spheres * exact.scale().per_rate : 0;
}

}  // namespace needlework::kernels
