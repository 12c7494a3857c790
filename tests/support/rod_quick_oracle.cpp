// The oracle of rods in double, extended precision or quad, whichever is enough, for pairs that are
// far from every other decision.
//
// All is a difference from s = 0, where more digits have told which points of the axes are nearest:
// the square of the distance that points with other arms have at another time is the one there,
// plus
//   2 (D1 b1 - D2 b2) + |D1 u1 - D2 u2|^2 + |g(s)|^2 - |g(0)|^2
// with D1, D2 how far the arms have moved, g the gap between the points whose arms have not, and
// b = g . u. Each of these is small where s is, so that rounding is small compared with how far the
// rods have moved, not with how large they are: rods that have just collided are no exception.
// Where axes are nearly parallel, u1 - u2 (or u1 + u2) has its own digits.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "tests/support/rod_oracle.h"

namespace needlework::test {
namespace {

// Bound on the roundings of an evaluation, in units of its largest term.
constexpr double roundings = 16;
// Times are known to this share, or left to more digits.
constexpr double enough_of_time = 1e-6;
// Shorter intervals, relative to their end, are left to more digits; so are ends so early, as a
// share of the time in which rods move by their size.
template <class Real>
constexpr double shortest = std::is_same_v<Real, Quad> ? 1e-20 : 1e-11;
constexpr double soonest = 1e-24;

// u (cos - 1) + p sin, and its size or more.
template <class Real>
struct Turned {
  Vec<Real> change;
  Real angle;
};

template <class Real>
class RodDifferences {
 public:
  // Of the square of the distance above that at contact.
  struct Excess {
    Real value, noise;
    bool is_above() const { return value > noise; }
    bool is_below() const { return value < -noise; }
  };

  template <class Fine>
  RodDifferences(const RodMotion<Fine>& motion, const Fine& contact) {
    using std::acos;
    const typename RodMotion<Fine>::Nearest start = motion.nearest(Fine(0));
    for (int i = 0; i < 2; ++i) {
      omega_[i] = static_cast<Real>(motion.omega[i]);
      u_[i] = convert<Real>(start.director[i]);
      // A quarter of a turn later.
      const Vec<Fine> turned = motion.omega[i] > 0
                                   ? motion.director(i, Fine(acos(Fine(0))) / motion.omega[i])
                                   : Vec<Fine>{Fine(0), Fine(0), Fine(0)};
      p_[i] = convert<Real>(turned);
      low_[i] = static_cast<Real>(Fine(-motion.half[i] - start.arm[i]));
      high_[i] = static_cast<Real>(Fine(motion.half[i] - start.arm[i]));
      arm_[i] = static_cast<Real>(start.arm[i]);
      b0_[i] = static_cast<Real>(dot(start.gap, start.director[i]));
      half_[i] = static_cast<Real>(motion.half[i]);
    }
    side_ = dot(u_[0], u_[1]) < 0 ? -1 : 1;
    const Vec<Fine> m = start.director[0] - Fine(side_) * start.director[1];
    m0_ = convert<Real>(m);
    bm0_ = static_cast<Real>(dot(start.gap, m));
    g0_ = convert<Real>(start.gap);
    v_ = convert<Real>(motion.v);
    excess0_ = static_cast<Real>(start.square - contact * contact);
    length_ = 2 * (half_[0] + half_[1]);
    size_ = norm(g0_) + length_;
    const auto left = static_cast<Real>(std::numeric_limits<Fine>::epsilon());
    noise0_ = roundings * left * (size_ + static_cast<Real>(motion.reach)) * size_;
    contact_ = static_cast<Real>(contact);
    speed_ = static_cast<Real>(motion.speed) * (1 + 1e-12);
    acceleration_ =
        (half_[0] * omega_[0] * omega_[0] + half_[1] * omega_[1] * omega_[1]) * (1 + 1e-12);
  }

  Excess at(Real s) const {
    using std::abs, std::min, std::sin, std::sqrt;
    Turned<Real> turned[2];
    for (int i = 0; i < 2; ++i) {
      const Real angle = omega_[i] * s, sine = sin(Real(angle / 2));
      turned[i] = {(-2 * sine * sine) * u_[i] + Real(sin(angle)) * p_[i], angle};
    }
    const Vec<Real>&e1 = turned[0].change, &e2 = turned[1].change;
    const Vec<Real> dg = (s * v_ + arm_[0] * e1) - arm_[1] * e2, g = g0_ + dg;
    const Vec<Real> u1 = u_[0] + e1;
    const Vec<Real> dm = e1 - side_ * e2, m = m0_ + dm;
    const Real b1 = b0_[0] + dot(dg, u_[0]) + dot(g, e1), b2 = b0_[1] + dot(dg, u_[1]) + dot(g, e2),
               bm = bm0_ + dot(dg, m0_) + dot(g, dm);
    // Bounds on the terms of these, which are rounded as they are.
    const Real way = speed_ * s, g_size = norm(g0_) + way, g_now = norm(g);
    const Real w1 = turned[0].angle, w2 = turned[1].angle, w = w1 + w2;
    const Real m_size = norm(m0_) + w;
    const auto size_of_b = [&](int i, Real angle) {
      return abs(b0_[i]) + way + g_now * angle + g_size * min(angle, Real(2));
    };
    const Real size1 = size_of_b(0, w1), size2 = size_of_b(1, w2);
    const Real size_m = abs(bm0_) + way * norm(m0_) + g_now * w + g_size * min(w, Real(4));
    const Real moved = dot(dg, g0_ + g) + excess0_;
    const Real moved_size = way * (2 * g_size) + abs(excess0_);

    const Real mm = dot(m, m), c12 = side_ * (1 - 0.5 * mm);
    const Vec<Real> x = cross(u1, m);
    const Real xx = dot(x, x);
    Real low = std::numeric_limits<Real>::infinity(), high = low;
    const auto consider = [&](Real d1, Real d2) {
      const Real along = d1 - side_ * d2, across = side_ * d2;
      const Vec<Real> y = along * u1 + across * m;
      const Real value = 2 * (along * b1 + across * bm) + dot(y, y) + moved;
      // `along` is rounded as the arms are, which y feels along u1.
      const Real y_along = abs(along) + abs(d2) * mm, y_size = abs(along) + abs(d2) * m_size;
      const Real rounding = 2 * ((abs(along) + length_) * size1 + abs(d2) * size_m) +
                            2 * length_ * y_along + y_size * y_size + moved_size;
      const Real noise = roundings * unit_roundoff<Real>() * rounding;
      low = min(low, value - noise);
      high = min(high, value + noise);
    };
    const auto clamped = [&](int i, Real d) { return std::clamp(d, low_[i], high_[i]); };
    for (const Real& d1 : {low_[0], high_[0]}) consider(d1, clamped(1, b2 + c12 * d1));
    for (const Real& d2 : {low_[1], high_[1]}) consider(clamped(0, c12 * d2 - b1), d2);
    Real soft = 0;
    if (xx > 0) {
      const Real d1 = (-bm - 0.5 * side_ * mm * b2) / xx, d2 = side_ * (0.5 * mm * b1 - bm) / xx;
      if (d1 > low_[0] && d1 < high_[0] && d2 > low_[1] && d2 < high_[1]) {
        consider(d1, d2);
        soft = (size_m + mm * (size1 + size2)) / sqrt(xx);
      }
    }
    // What arms are off matters to second order.
    const Real off = roundings * unit_roundoff<Real>() * (size1 + size2 + length_ + soft);
    return {Real(0.5) * (low + high), Real(0.5) * (high - low) + off * off + noise0_};
  }
  Real distance(const Excess& at) const {
    using std::sqrt;
    return sqrt(Real(std::max(Real(0), at.value) + contact_ * contact_));
  }
  /// Bound on the second derivative of squares of distances of the points that are nearest at any
  /// time in an interval of this length.
  Real curvature(const Excess& begin, Real h) const {
    return 2 * speed_ * speed_ + 2 * (distance(begin) + 2 * speed_ * h) * acceleration_;
  }
  Real speed() const { return speed_; }
  Real size() const { return size_ + contact_; }

 private:
  Vec<Real> u_[2], p_[2], g0_, m0_, v_;
  Real omega_[2], low_[2], high_[2], arm_[2], half_[2], b0_[2];
  Real bm0_ = 0, side_ = 1, excess0_ = 0, noise0_ = 0, size_ = 0, length_ = 0, contact_ = 0,
       speed_ = 0, acceleration_ = 0;
};

// The square q of the distance is the least of many functions whose second derivatives are at most
// C, so q - C s^2 / 2 is concave: q is at most C (s - a)(b - s) / 2 below its chord, and where it
// falls by more than C h in the time h, it fell before and falls after.
template <class Real>
class QuickRodOracle {
 public:
  explicit QuickRodOracle(const RodDifferences<Real>& rods) : rods_(rods) {}

  std::optional<RodAnswer> run(Real horizon) {
    Excess start = rods_.at(0);
    ++answer_.evaluations;
    if (start.is_below()) return std::nullopt;
    if (!start.is_above()) start.value = 0;  // they touch
    if (!rods_.speed() || horizon <= 0) return answer_;
    const bool is_done = search(0, start, horizon, at(horizon));
    if (!is_done && !is_clear_) return std::nullopt;
    return answer_;
  }

 private:
  using Excess = typename RodDifferences<Real>::Excess;

  Excess at(Real s) {
    ++answer_.evaluations;
    return rods_.at(s);
  }
  bool give_up() {
    is_clear_ = false;
    return false;
  }
  // Whether there is a contact in [a, b]; none before a. What is not clear ends the search.
  bool search(Real a, const Excess& at_a, Real b, const Excess& at_b) {
    if (!is_clear_) return false;
    const Real h = b - a, c = rods_.curvature(at_a, h);
    if (is_free(at_a, at_b, c * h * h)) return false;
    if (at_b.is_below() && at_a.is_above()) {
      const Real later = a + h / 64;
      const Excess next = at(later);
      if (falls(at_a, next, h, c)) return root(later, next, b, at_b);
    }
    const Real middle = a + 0.5 * h;
    if (h < shortest<Real> * b || rods_.speed() * b < soonest * rods_.size()) return give_up();
    const Excess at_middle = at(middle);
    return search(a, at_a, middle, at_middle) || search(middle, at_middle, b, at_b);
  }
  // The least of at_a + (at_b - at_a) x - C h^2 x (1 - x) / 2 for x in [0, 1].
  static bool is_free(const Excess& at_a, const Excess& at_b, Real chh) {
    const Real noise = at_a.noise + at_b.noise, slack = 2 * noise;
    const Real low = at_a.value == 0 ? 0 : at_a.value - slack, high = at_b.value - slack;
    if (at_a.value == 0) return high > 0.5 * chh;  // the excess at a is above or the start
    if (!(low > 0 && high > 0)) return false;
    const Real x = 0.5 - (high - low) / chh;
    if (x <= 0 || x >= 1) return true;
    return low + (high - low) * x - 0.5 * chh * x * (1 - x) > 0;
  }
  // Whether the excess stays above 0 for h / 64, in which it falls faster than it could rise in h.
  static bool falls(const Excess& at_a, const Excess& next, Real h, Real c) {
    const Real step = h / 64;
    const Real fallen = (at_a.value - next.value) - (at_a.noise + next.noise);
    return next.is_above() && is_free(at_a, next, c * step * step) && fallen > c * h * step;
  }
  // One sign change in [a, b].
  bool root(Real a, Excess at_a, Real b, Excess at_b) {
    for (int i = 0; i < 400; ++i) {
      if (b - a <= enough_of_time * b) {
        answer_.contact = true;
        answer_.time = 0.5 * (a + b);
        return true;
      }
      const Real share = at_a.value / (at_a.value - at_b.value);
      // Now and then the middle; else to both sides of where the chord leads.
      Real s = a + (b - a) * (i % 3 == 2 ? 0.5 : share);
      const Real off = 0.4 * enough_of_time * s;
      if (i % 3 == 0) s += off;
      if (i % 3 == 1) s -= off;
      if (!(s > a && s < b)) s = a + 0.5 * (b - a);
      const Excess now = at(s);
      if (now.is_below()) {
        b = s, at_b = now;
      } else if (now.is_above()) {
        a = s, at_a = now;
      } else {
        return give_up();
      }
    }
    return give_up();
  }

  const RodDifferences<Real>& rods_;
  RodAnswer answer_;
  bool is_clear_ = true;
};

// From where on 64 bits do not tell the start well enough.
constexpr long double touching_below = 1e-9L;

template <class Real, class Fine>
std::optional<RodAnswer> answer_in(const RodMotion<Fine>& motion, const Fine& contact,
                                   double horizon) {
  return QuickRodOracle<Real>(RodDifferences<Real>(motion, contact)).run(horizon);
}

}  // namespace

std::optional<RodAnswer> quick_rod_contact(const RodCase& rods) {
  if (rods.pair.growth != 0) return std::nullopt;
  const RodMotion<long double> motion(rods);
  const long double contact = rods.pair.distance;
  const long double size = motion.reach + motion.half[0] + motion.half[1] + contact;
  const bool is_apart = motion.distance(0) - contact > touching_below * size;
  if (is_apart) {
    if (auto answer = answer_in<double>(motion, contact, rods.horizon)) return answer;
  }
  const RodMotion<Quad> precise(rods);
  const Quad begins = precise.distance(0), expected = rods.pair.distance;
  const Quad least = begins < expected ? begins : expected;
  if (!is_apart) {
    if (auto answer = answer_in<double>(precise, least, rods.horizon)) return answer;
  }
  if (auto answer = answer_in<long double>(precise, least, rods.horizon)) return answer;
  return answer_in<Quad>(precise, least, rods.horizon);
}

}  // namespace needlework::test
