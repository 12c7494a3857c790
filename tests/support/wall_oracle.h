// First contacts of tips with walls, by halving intervals and with 113 bits where fewer cannot
// decide: independent of the kernel, and quick enough for millions of cases.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "kernels/wall_contact.h"
#include "src/audit/quad.h"
#include "src/box/moving_edge.h"
#include "src/physics/director.h"

namespace needlework::test {

using WallQuad = audit::Quad;

/// A needle and a wall.
struct WallCase {
  kernels::Flight flight;
  kernels::WallApproach approach;

  WallCase() { approach.flight = &flight; }
  WallCase(const WallCase& other) : flight(other.flight), approach(other.approach) {
    approach.flight = &flight;
  }
  WallCase& operator=(const WallCase&) = delete;
};

/// The height of a tip over the wall as a function of time, in numbers of this type. A tip that has
/// just hit the wall starts from height 0.
template <class Real>
class TipHeight {
 public:
  TipHeight(const WallCase& of, int tip) {
    const kernels::WallApproach& a = of.approach;
    const kernels::Flight& flight = of.flight;
    const int axis = a.wall.axis, next = (axis + 1) % 3, last = (axis + 2) % 3;
    const Real sign = a.wall.normal;
    const Real half = sign * Real(tip == 0 ? a.half : -a.half);
    const auto w = [&](int n) { return Real(component(flight.w, n)); };
    const auto u = [&](int n) { return Real(component(flight.u, n)); };
    using std::sqrt, std::sin, std::cos;
    omega_ = sqrt(Real(w(0) * w(0) + w(1) * w(1) + w(2) * w(2)));
    along_ = half * u(axis);
    if (omega_ > 0) across_ = half * (w(next) * u(last) - w(last) * u(next)) / omega_;
    const auto above = [&](const DoubleDouble& place) {
      return Real(sign * (Real(component(flight.r, axis)) - (Real(place.hi) + Real(place.lo))));
    };
    start_ = above(a.wall.place);
    halt_ = a.wall.halt;
    start_halted_ = above(a.wall.halt_place);
    speed_halted_ = sign * Real(component(flight.v, axis));
    speed_ = speed_halted_ - sign * Real(a.wall.velocity);
    half_fall_ = sign * Real(a.gravity) / 2;
    amplitude_ = sign * Real(a.wall.amplitude);
    static const Real two_pi = 4 * WallQuad(acos(WallQuad(0))).template convert_to<Real>();
    turn_ = two_pi * Real(a.wall.frequency);
    const Real phase = two_pi * (Real(a.turns.hi) + Real(a.turns.lo));
    sine_ = sin(phase);
    cosine_ = cos(phase);
    if ((a.touching >> tip & 1) != 0) {
      const Real off = height(Real(0));
      start_ -= off;
      start_halted_ -= off;
    }
  }

  Real height(const Real& s) const { return height(s, s >= halt_); }
  Real rate(const Real& s) const { return rate(s, s >= halt_); }
  /// Over the wall as it is before or after it halts.
  Real height(const Real& s, bool halted) const {
    using std::sin, std::cos;
    Real out = (halted ? start_halted_ + (speed_halted_ + half_fall_ * s) * s
                       : start_ + (speed_ + half_fall_ * s) * s) +
               along_ * cos(Real(omega_ * s)) + across_ * sin(Real(omega_ * s));
    if (amplitude_ != 0) {
      out -= amplitude_ * (sine_ * cos(Real(turn_ * s)) + cosine_ * sin(Real(turn_ * s)));
    }
    return out;
  }
  Real rate(const Real& s, bool halted) const {
    using std::sin, std::cos;
    Real out = (halted ? speed_halted_ : speed_) + 2 * half_fall_ * s +
               omega_ * (across_ * cos(Real(omega_ * s)) - along_ * sin(Real(omega_ * s)));
    if (amplitude_ != 0) {
      out -= amplitude_ * turn_ * (cosine_ * cos(Real(turn_ * s)) - sine_ * sin(Real(turn_ * s)));
    }
    return out;
  }
  /// Bound on the second derivative.
  Real bend() const {
    using std::sqrt, std::abs;
    return 2 * abs(half_fall_) + omega_ * omega_ * sqrt(Real(along_ * along_ + across_ * across_)) +
           abs(amplitude_) * turn_ * turn_;
  }
  /// Of heights, by far more than arithmetic with 64 bits loses up to this time.
  Real rounding(const Real& to) const {
    using std::abs;
    return Real(0x1p-56) *
           (abs(start_) + abs(start_halted_) + abs(along_) + abs(across_) + abs(amplitude_) +
            (abs(speed_) + abs(speed_halted_) + abs(half_fall_) * to) * to) *
           (1 + (omega_ + turn_) * to);
  }

 private:
  Real start_, speed_, start_halted_, speed_halted_, half_fall_, omega_,
      along_ = 0, across_ = 0, amplitude_, turn_, sine_, cosine_;
  double halt_;
};

/// The first time up to `to` at which the tip comes to the wall, if it does.
class TipRoots {
 public:
  TipRoots(const WallCase& of, int tip, double to)
      : of_(of), tip_(tip), rough_(of, tip), bend_(rough_.bend()), rounding_(rough_.rounding(to)) {
    const double halt = std::clamp(of.approach.wall.halt, 0.0, to);
    if (halt > 0) first_ = first_in(0, halt);
    halted_ = true;
    if (!first_ && halt < to) first_ = first_in(halt, to);
  }
  std::optional<WallQuad> first() const { return first_; }

 private:
  static int sign(const WallQuad& h) { return h > 0 ? 1 : h < 0 ? -1 : 0; }
  int sign_at(long double s) const {
    const long double h = rough_.height(s, halted_);
    return std::abs(h) > rounding_ ? (h > 0 ? 1 : -1) : sign(exact().height(WallQuad(s), halted_));
  }
  // The tip is not in the wall at `from`.
  std::optional<WallQuad> first_in(long double from, long double to) const {
    const long double middle = 0.5L * (from + to), half = 0.5L * (to - from);
    const long double h = rough_.height(middle, halted_), rate = rough_.rate(middle, halted_);
    if (h - (std::abs(rate) + 0.5L * bend_ * half) * half > rounding_) return std::nullopt;
    const bool is_tiny = half < 0x1p-58L * (1 + to);
    if (std::abs(rate) > bend_ * half + rounding_ * (1 + bend_) || is_tiny) {
      if (rate > 0 || sign_at(to) > 0) return std::nullopt;
      return root(from, to);
    }
    if (const auto left = first_in(from, middle)) return left;
    return first_in(middle, to);
  }
  // Between these times, of which the tip is above the wall at the first only: to 1e-20.
  WallQuad root(long double from, long double to) const {
    long double below = from, above = to;
    for (int n = 0; n < 80 && above - below > 0x1p-62L * (1 + above); ++n) {
      long double at = below - rough_.height(below, halted_) / rough_.rate(below, halted_);
      if (!(at > below && at < above) || n % 4 == 3) at = 0.5L * (below + above);
      (rough_.height(at, halted_) > 0 ? below : above) = at;
    }
    const WallQuad middle = 0.5L * (below + above), near = WallQuad(1e-20) * (1 + middle);
    const auto height = [&](const WallQuad& s) { return exact().height(s, halted_); };
    const WallQuad newton = middle - height(middle) / exact().rate(middle, halted_);
    if (newton - near > from && newton + near < to && height(newton - near) > 0 &&
        !(height(newton + near) > 0)) {
      return newton;
    }
    WallQuad low = from, high = to;
    while (high - low > near) {
      const WallQuad half = (low + high) / 2;
      (height(half) > 0 ? low : high) = half;
    }
    return high;
  }

  const TipHeight<WallQuad>& exact() const {
    if (!exact_) exact_.emplace(of_, tip_);
    return *exact_;
  }

  const WallCase& of_;
  const int tip_;
  TipHeight<long double> rough_;
  mutable std::optional<TipHeight<WallQuad>> exact_;  // made where it is needed
  long double bend_, rounding_;
  bool halted_ = false;
  std::optional<WallQuad> first_;
};

struct WallTruth {
  bool found = false;
  int tip = 0;
  double time = 0;
  bool is_of_both = false;  ///< both tips come at one time, as far as double can tell
};

inline WallTruth first_wall_contact_in_quad(const WallCase& of, double to) {
  WallTruth out;
  std::optional<WallQuad> first;
  for (const int tip : {0, 1}) {
    const auto found = TipRoots(of, tip, to).first();
    if (!found) continue;
    if (first) {
      const WallQuad apart = *found - *first;
      using std::abs;
      out.is_of_both = abs(apart) < WallQuad(4 * of.approach.resolution);
      if (apart >= 0) continue;
    }
    first = found;
    out.found = true;
    out.tip = tip;
    out.time = static_cast<double>(*found);
  }
  return out;
}

/// How needles and walls are drawn.
enum class WallFamily {
  resting,    ///< walls at rest, free flight
  moving,     ///< walls that vibrate
  falling,    ///< under gravity, over walls at rest
  shaken,     ///< under gravity, over walls that vibrate
  advancing,  ///< walls of constant velocity, slow and fast, with and without gravity
  halting,    ///< such walls that come to rest within the time of the search
  grazing,    ///< a tip comes within 1e-3 to 1e-15 of the wall, or so far into it
  lying,      ///< directors nearly along the wall, so that both tips come at almost one time
  bouncing,   ///< a tip has just hit the wall, and is off it by rounding
};
inline constexpr int wall_families = 9;
inline const char* name_of(WallFamily family) {
  constexpr const char* names[] = {"resting", "moving",  "falling", "shaken",  "advancing",
                                   "halting", "grazing", "lying",   "bouncing"};
  return names[static_cast<int>(family)];
}

class DrawnWalls {
 public:
  explicit DrawnWalls(std::uint64_t seed) : random_(seed) {}

  /// Neither tip is in the wall at the record.
  WallCase draw(WallFamily family) {
    for (;;) {
      WallCase out = any(family);
      if (family == WallFamily::grazing && !let_graze(out)) continue;
      if (family == WallFamily::bouncing && !let_bounce(out)) continue;
      const auto is_above = [&](int tip) {
        const bool touches = (out.approach.touching >> tip & 1) != 0;
        return touches || TipHeight<double>(out, tip).height(0.0) > 1e-9;
      };
      if (is_above(0) && is_above(1)) return out;
    }
  }

 private:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  Vec3d normal() {
    std::normal_distribution<double> n;
    const double x = n(random_), y = n(random_);
    return {x, y, n(random_)};
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  double small() { return std::pow(10.0, uniform(-15, -3)) * (below(2) == 0 ? 1 : -1); }

  static double& along(Vec3d& a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }

  WallCase any(WallFamily family) {
    WallCase out;
    kernels::WallApproach& a = out.approach;
    a.wall.axis = below(3);
    a.wall.normal = below(2) == 0 ? 1 : -1;
    a.wall.place = uniform(-3, 3);
    a.half = uniform(0.05, 1);
    const bool is_hard = family >= WallFamily::grazing;
    const bool travels = family == WallFamily::advancing || family == WallFamily::halting;
    if (family == WallFamily::falling || family == WallFamily::shaken ||
        ((is_hard || travels) && below(2) == 0)) {
      a.gravity = a.wall.normal * uniform(-3, 1);
    }
    // Half of the hard cases shake, a quarter travels.
    const int motion = is_hard ? below(8) : -1;
    if (family == WallFamily::moving || family == WallFamily::shaken || motion >= 4) {
      a.wall.amplitude = uniform(0, 0.5);
      a.wall.frequency = uniform(0.1, 3);
      a.turns = DoubleDouble(uniform(0, 1));
    }
    if (travels || motion == 0 || motion == 1)
      let_travel(a.wall, family == WallFamily::halting || motion == 1);
    a.resolution = 0x1p-52;
    a.tolerance = 0x1p-44;
    kernels::Flight& f = out.flight;
    Vec3d director = normal();
    if (family == WallFamily::lying) along(director, a.wall.axis) = below(8) == 0 ? 0 : small();
    f.u = normalised(director);
    f.v = normal();
    f.w = project_out(normal() * (below(8) == 0 ? 0 : 3), f.u);
    set_rotation(f);
    f.r = normal();
    along(f.r, a.wall.axis) = a.wall.place.hi + a.wall.normal * uniform(0, 1.5);
    return out;
  }
  // As walls do whose surface has been on its way for some time, with the rounding of that. Speeds
  // reach beyond those of all tips; times at which much slower ones meet round by more than the
  // comparison allows.
  void let_travel(kernels::WallPlane& wall, bool halts) {
    const double speed = std::pow(10.0, uniform(-2, 0.7)), now = uniform(0, 100);
    const double velocity = below(2) == 0 ? speed : -speed, start = wall.place.hi;
    const double stop = start + velocity * (now + uniform(0, 3));
    const MovingEdge edge(start, velocity, halts ? std::optional(stop) : std::nullopt);
    wall.place = edge.place(now);
    if (edge.is_at_rest(now)) return;
    wall.velocity = velocity;
    if (halts) wall.halt = to_double(edge.halt_time() - DoubleDouble(now));
    wall.halt_place = edge.stop();
  }
  // Moves the needle so that the lowest place of one tip is a little above or below the wall.
  bool let_graze(WallCase& of) {
    const TipHeight<double> height(of, below(2));
    double lowest = 0;
    constexpr int steps = 64;
    constexpr double longest = 3;
    for (int n = 1; n <= steps; ++n) {
      const double at = longest * n / steps;
      if (height.height(at) < height.height(lowest)) lowest = at;
    }
    double low = lowest - longest / steps, high = lowest + longest / steps;
    if (low < 0 || high > longest) return false;
    for (int n = 0; n < 60; ++n) {
      const double middle = 0.5 * (low + high);
      (height.rate(middle) < 0 ? low : high) = middle;
    }
    along(of.flight.r, of.approach.wall.axis) -=
        of.approach.wall.normal * (height.height(low) - small());
    return true;
  }
  // Moves the needle so that a tip is at the wall, to within rounding, and moves away from it.
  bool let_bounce(WallCase& of) {
    const int tip = below(2);
    const TipHeight<double> height(of, tip);
    double& r = along(of.flight.r, of.approach.wall.axis);
    r -= of.approach.wall.normal * height.height(0.0);
    const double away = std::pow(10.0, uniform(-6, 0));
    along(of.flight.v, of.approach.wall.axis) -=
        of.approach.wall.normal * (height.rate(0.0) - away);
    of.approach.touching = 1u << tip;
    return TipHeight<double>(of, 1 - tip).height(0.0) > 1e-3 * of.approach.half;
  }

  std::mt19937_64 random_;
};

/// What the kernel found, compared with the truth.
struct WallComparison {
  std::uint64_t cases = 0, contacts = 0, missed = 0, invented = 0, wrong_tip = 0, off = 0;

  /// `of` within this time.
  void add(const WallCase& of, double to) {
    ++cases;
    const kernels::WallContact found = first_wall_contact(of.approach, 0, to);
    const WallTruth truth = first_wall_contact_in_quad(of, to);
    if (truth.found && std::abs(truth.time - to) < 1e-12) return;
    contacts += truth.found;
    if (found.found != truth.found) {
      ++(truth.found ? missed : invented);
      return;
    }
    if (!found.found) return;
    wrong_tip += found.tip != truth.tip && !truth.is_of_both;
    off += !(std::abs(found.elapsed - truth.time) <= 1e-14);
  }
  std::uint64_t wrong() const { return missed + invented + wrong_tip + off; }
};

}  // namespace needlework::test
