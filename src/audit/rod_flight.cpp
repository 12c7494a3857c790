#include "src/audit/rod_flight.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "src/audit/dual.h"

namespace needlework::audit {
namespace {

/// Half a unit in the last place of 1.
constexpr double half_unit_of_rods = 0x1p-53;
/// What is certified is twice this share of the distance of the axes at a contact.
constexpr double most_overlap = 0.5e-13;
/// Number of intervals of a flight after which the rest counts as doubtful.
constexpr int most_stretches_of_rods = 10000;

/// Which points of the axes are nearest: between both ends of an axis, or one of its ends.
enum class Nearest { sides, end_of_first, end_of_second, points };

/// Both rods at a time, or in an interval of it.
template <class Number>
struct Rods {
  Vector<Number> r, u1, u2;
  Number grown = 1;  ///< lengths as multiples of those at which arms are given
};

/// What is nearest, roughly: any points bound the distance from above. Arms grow with the rods.
struct Arms {
  Nearest kind = Nearest::points;
  double first = 0, second = 0;
};

template <class Number>
Vector<Number> between(const Rods<Number>& rods, const Arms& arms) {
  return rods.r + rods.u1 * (Number(arms.first) * rods.grown) -
         rods.u2 * (Number(arms.second) * rods.grown);
}

/// The best of all candidates: both lines, and each end with the other axis.
Arms nearest_arms(const Rods<double>& rods, const std::array<double, 2>& half) {
  Arms best;
  double least = HUGE_VAL;
  const auto take = [&](const Arms& arms) {
    const Vector<double> p = between(rods, arms);
    const double square = dot(p, p);
    if (square < least) {
      least = square;
      best = arms;
    }
  };
  const Vector<double> x = cross(rods.u1, rods.u2);
  const double xx = dot(x, x);
  if (xx > 0) {
    const double a = dot(cross(rods.u2, rods.r), x) / xx, b = dot(cross(rods.u1, rods.r), x) / xx;
    if (std::abs(a) < half[0] && std::abs(b) < half[1]) take({Nearest::sides, a, b});
  }
  for (const double sign : {1.0, -1.0}) {
    const double a = sign * half[0];
    const double b = std::clamp(dot(rods.u2, rods.r + rods.u1 * a), -half[1], half[1]);
    take({std::abs(b) < half[1] ? Nearest::end_of_first : Nearest::points, a, b});
    const double c = sign * half[1];
    const double d = std::clamp(dot(rods.u1, rods.u2 * c - rods.r), -half[0], half[0]);
    take({std::abs(d) < half[0] ? Nearest::end_of_second : Nearest::points, d, c});
  }
  return best;
}

/// |m|^2 or, of two sides, (m . r)^2 / |m|^2, and m . u of the axes that m is not normal to.
template <class Number>
struct Separation {
  Number square;
  std::array<std::optional<Number>, 2> along;
};

/// `arms.kind` is not `sides`, or the directors are certainly not parallel.
template <class Number>
Separation<Number> separation_of(const Rods<Number>& rods, const Arms& arms) {
  if (arms.kind == Nearest::sides) {
    const Vector<Number> x = cross(rods.u1, rods.u2);
    const Number f = dot(rods.r, x);
    return {f * f / dot(x, x), {}};
  }
  const Vector<Number> p = between(rods, arms);
  if (arms.kind == Nearest::end_of_first) {
    const Vector<Number> m = p - rods.u2 * dot(p, rods.u2);
    return {dot(m, m), {dot(m, rods.u1), std::nullopt}};
  }
  if (arms.kind == Nearest::end_of_second) {
    const Vector<Number> m = p - rods.u1 * dot(p, rods.u1);
    return {dot(m, m), {std::nullopt, dot(m, rods.u2)}};
  }
  return {dot(p, p), {dot(p, rods.u1), dot(p, rods.u2)}};
}

template <class Real>
using Moving = Dual<Ball<Real>>;

template <class Real>
Vector<Moving<Real>> dual(const Vector<Ball<Real>>& value, const Vector<Ball<Real>>& rate) {
  Vector<Moving<Real>> out;
  for (int axis = 0; axis < 3; ++axis) out[axis] = {value[axis], rate[axis]};
  return out;
}

/// Bounds on all numbers in a ball that changes by at most `change`.
template <class Real>
std::pair<double, double> range(const Ball<Real>& ball, double change) {
  const double middle = static_cast<double>(ball.middle);
  const double off = (ball.radius + change + std::abs(middle) * 0x1p-52) * upward;
  return {middle - off, middle + off};
}

}  // namespace

template <class Real>
RodFlight::Motion<Real> RodFlight::motion() const {
  const Instant begin = std::max(first_.record.time, second_.record.time);
  const std::array delay = {elapsed<Real>(first_.record.time, begin),
                            elapsed<Real>(second_.record.time, begin)};
  const auto flight = [&](const Needle& needle, std::size_t i) {
    if constexpr (std::is_same_v<Real, double>) {
      return without_gravity(needle.flight, space_.gravity, delay[i]);
    } else {
      return without_gravity(needle.flight_as<Ball<Real>>(), space_.gravity, delay[i]);
    }
  };
  const std::array flights = {flight(first_, 0), flight(second_, 1)};
  Ball<Real> growth = 0;
  if (space_.growth) {
    const Quad rate = space_.growth->relative_rate_at(begin);
    growth = {Real(rate), magnitude(rate) * unit_roundoff<Real>};
  }
  return {flights, delay,
          separation(flights[0], flights[1], delay[0], delay[1], shift_, space_.box),
          flights[0].v - flights[1].v, growth};
}

RodFlight::RodFlight(const Needle& first, const Needle& second, const Shift& shift,
                     const Space& space, double slack)
    : first_(first),
      second_(second),
      shift_{{double(shift[0]), double(shift[1]), double(shift[2])}},
      space_(space.around(first.record.r).around(second.record.r)),
      slack_(slack),
      scale_(space.scale_at(std::max(first.record.time, second.record.time))),
      contact_(0.5 * (first.body.diameter + second.body.diameter) * scale_),
      size_(0.5 * (first.body.length + second.body.length) * scale_ + contact_),
      half_lengths_{0.5 * first.body.length * scale_, 0.5 * second.body.length * scale_},
      omega_{upper(first.flight.omega), upper(second.flight.omega)},
      motion_(motion<double>()) {
  for (std::size_t i = 0; i < 2; ++i) {
    const Record& record = i == 0 ? first.record : second.record;
    delays_[i] = upper(motion_.delay[i]);
    velocity_[i] = (norm(record.v) + 2 * norm(space.gravity) * delays_[i]) * upward;
  }
  distance_ = upper(norm(motion_.r));
  centres_ = upper(norm(motion_.v));
  growth_ = upper(motion_.growth);
  speed_ = (centres_ + growth_ * size_) * upward;
  tips_ = half_lengths_[0] * omega_[0] + half_lengths_[1] * omega_[1];
}

const RodFlight::Motion<Quad>& RodFlight::in_quad() {
  if (!precise_) precise_ = motion<Quad>();
  return *precise_;
}

double RodFlight::limit(double s) const {
  double lengths = distance_ + 2 * centres_ * std::abs(s), directors = 0;
  bool renewed = space_.rounds();
  for (std::size_t i = 0; i < 2; ++i) {
    const double age = delays_[i] + std::abs(s);
    const double extent = (i == 0 ? first_ : second_).body.extent();
    lengths += velocity_[i] * delays_[i] + norm((i == 0 ? first_ : second_).record.r);
    directors += half_lengths_[i] * grown(s) * (2 + omega_[i] * age);
    renewed =
        renewed || velocity_[i] * age > longest_record * extent || omega_[i] * age > longest_record;
  }
  const double sizes =
      space_.growth ? space_.growth->off(scale_ * grown(s)) * size_ * grown(s) : 0.0;
  return most_overlap * contact(s) + 4 * half_unit_of_rods * (lengths + directors) + sizes +
         (renewed ? space_.rounding() : 0) + speed(s) * (2 * resolution + slack_);
}

double RodFlight::noise_of_rate(double s) const {
  double acceleration = 0;
  for (std::size_t i = 0; i < 2; ++i)
    acceleration += half_lengths_[i] * omega_[i] * (omega_[i] * grown(s) + 2 * growth_);
  const double bend = speed(s) * speed(s) / contact(s) + acceleration, off = limit(s);
  return speed(s) * (0x1p-44 + 16 * off / contact(s)) + std::sqrt(2 * bend * off);
}

namespace {

template <class Real>
struct Bounds {
  double least = 0, most = HUGE_VAL;
  Arms arms;
};

/// By how much m . u may differ from that in the middle.
using Changes = std::array<double, 2>;

/// What an axis takes off m . r: (L / 2) |c| + a c for c = m . u, which is convex in c.
double taken_off(const std::pair<double, double>& c, double half, double arm) {
  const auto at = [&](double value) { return half * std::abs(value) + arm * value; };
  return std::max({0.0, at(c.first), at(c.second)}) * upward;
}

template <class Real>
double taken_off(const Separation<Ball<Real>>& middle, const Arms& arms,
                 const std::array<double, 2>& half, const Changes& change) {
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!middle.along[i]) continue;
    const auto c = range(*middle.along[i], change[i]);
    sum += taken_off(c, half[i], i == 0 ? arms.first : -arms.second);
  }
  return sum;
}

/// Of |m|^2, or what stands for it, beyond the square of the distance that is enough.
template <class Number>
Number excess_of(const Separation<Number>& separation, const Rods<Number>& rods, double contact,
                 double limit) {
  const Number enough = Number(contact) * rods.grown - Number(2 * limit);
  return separation.square - enough * enough;
}

/// Whether d > D follows from |m|^2 - D^2 >= excess, for no D above `most`: d |m| >= |m|^2 - taken,
/// and |m|^2 - D |m| is the excess times |m| / (|m| + D), which falls with D.
bool is_beyond(double excess, double taken, double most) {
  if (!(excess > 0)) return false;
  const double m = std::sqrt(most * most + excess) * downward;
  return excess * (m / (m + most)) * downward > taken;
}

template <class Real>
Rods<Ball<Real>> rods_of(const auto& motion, const Ball<Real>& s) {
  return {motion.r + motion.v * s, motion.flights[0].at(motion.delay[0] + s).u,
          motion.flights[1].at(motion.delay[1] + s).u};
}
/// The same with arms that are given as of another time.
template <class Real>
Rods<Ball<Real>> rods_of(const auto& motion, const Ball<Real>& s, const Ball<Real>& arms_at) {
  Rods<Ball<Real>> out = rods_of<Real>(motion, s);
  out.grown = motion.grown(s) / motion.grown(arms_at);
  return out;
}

template <class Real>
Rods<Moving<Real>> moving_rods_of(const auto& motion, const Ball<Real>& s,
                                  const Ball<Real>& arms_at) {
  const auto first = motion.flights[0].at(motion.delay[0] + s);
  const auto second = motion.flights[1].at(motion.delay[1] + s);
  const Ball<Real> then = motion.grown(arms_at);
  return {dual<Real>(motion.r + motion.v * s, motion.v),
          dual<Real>(first.u, first.du),
          dual<Real>(second.u, second.du),
          {motion.grown(s) / then, motion.growth / then}};
}

template <class Real>
Vector<double> middle_of(const Vector<Ball<Real>>& a) {
  return {{static_cast<double>(a[0].middle), static_cast<double>(a[1].middle),
           static_cast<double>(a[2].middle)}};
}

template <class Real>
bool are_parallel(const Rods<Ball<Real>>& rods) {
  const auto x = cross(rods.u1, rods.u2);
  return !(lower(dot(x, x)) > 0);
}
template <class Real>
bool are_parallel(const Rods<Moving<Real>>& rods) {
  return are_parallel(Rods<Ball<Real>>{{},
                                       {{rods.u1[0].value, rods.u1[1].value, rods.u1[2].value}},
                                       {{rods.u2[0].value, rods.u2[1].value, rods.u2[2].value}}});
}

/// The directions to try: that of the points that are nearest, then the line through them.
std::array<Arms, 2> directions(const Arms& arms) {
  return {arms, {Nearest::points, arms.first, arms.second}};
}

/// The distance at one time.
template <class Real>
Bounds<Real> distance_of(const Rods<Ball<Real>>& rods, const std::array<double, 2>& half) {
  Bounds<Real> out;
  out.arms = nearest_arms({middle_of(rods.r), middle_of(rods.u1), middle_of(rods.u2)}, half);
  const auto p = between(rods, out.arms);
  out.most = std::sqrt(upper(dot(p, p))) * upward;
  for (const Arms& arms : directions(out.arms)) {
    if (arms.kind == Nearest::sides && are_parallel(rods)) continue;
    const Separation<Ball<Real>> at = separation_of(rods, arms);
    const double square = range(at.square, 0).first;
    if (!(square > 0)) continue;
    const double m = std::sqrt(square) * downward;
    out.least = std::max(out.least, m - taken_off(at, arms, half, {}) / m);
    if (arms.kind == Nearest::points) break;
  }
  return out;
}

}  // namespace

template <class Real>
RodFlight::Settled RodFlight::settle(const Motion<Real>& motion, const Stretch& stretch,
                                     double limit) const {
  const double half = 0.5 * (stretch.end - stretch.begin), middle = stretch.begin + half;
  const double contact = this->contact(middle), enough = contact - 2 * limit;
  const std::array<double, 2> half_lengths = this->half_lengths(middle);
  const auto rods = rods_of<Real>(motion, Ball<Real>(middle));
  const Bounds<Real> bounds = distance_of(rods, half_lengths);
  if (bounds.most < contact - limit) return {Verdict::overlapping, true};
  if (bounds.least - speed(stretch.end) * half * upward > enough) return {Verdict::free, true};
  // Where the gap is larger than what is lost, shorter intervals help as well as more digits.
  const double lost = bounds.most - bounds.least;
  const bool exact = lost <= 0.25 * limit || bounds.least - enough > 4 * lost;
  const auto during =
      moving_rods_of<Real>(motion, {Real(middle), half * upward}, Ball<Real>(middle));
  const double grown = upper(during.grown.value), most_enough = grown * contact - 2 * limit;
  for (const Arms& arms : directions(bounds.arms)) {
    if (arms.kind == Nearest::sides && are_parallel(during)) continue;
    const Separation<Ball<Real>> at = separation_of(rods, arms);
    const Separation<Moving<Real>> change = separation_of(during, arms);
    Changes most{};
    for (std::size_t i = 0; i < 2; ++i) {
      if (change.along[i]) most[i] = upper(change.along[i]->rate) * half * upward;
    }
    const auto slope = excess_of(change, during, contact, limit).rate;
    const double taken = taken_off(at, arms, half_lengths, most) * grown;
    const double excess =
        range(excess_of(at, rods, contact, limit), upper(slope) * half * upward).first;
    if (is_beyond(excess, taken, most_enough)) return {Verdict::free, true};
    // It is least at one of the ends.
    const auto [falls, rises] = range(slope, 0);
    if (falls > 0 || rises < 0) {
      const double end = falls > 0 ? stretch.begin : stretch.end;
      const auto there = rods_of<Real>(motion, Ball<Real>(end), Ball<Real>(middle));
      if (arms.kind == Nearest::sides && are_parallel(there)) continue;
      const auto at_end = excess_of(separation_of(there, arms), there, contact, limit);
      if (is_beyond(range(at_end, 0).first, taken, most_enough)) return {Verdict::free, true};
    }
    if (arms.kind == Nearest::points) break;
  }
  return {Verdict::open, exact};
}

RodFlight::Distance RodFlight::at(double s) {
  const auto bounds_of = [&](const auto& motion, auto real) {
    using Real = decltype(real);
    return distance_of(rods_of<Real>(motion, Ball<Real>(s)), half_lengths(s));
  };
  const auto rods = moving_rods_of<double>(motion_, Ball<double>(s), Ball<double>(s));
  Bounds<double> bounds = bounds_of(motion_, double());
  if (bounds.most - bounds.least > 0.25 * limit(s)) {
    const auto precise = bounds_of(in_quad(), Quad());
    bounds = {precise.least, precise.most, precise.arms};
  }
  const auto p = between(rods, bounds.arms);
  double along = 0;
  for (int axis = 0; axis < 3; ++axis) along += p[axis].value.middle * p[axis].rate.middle;
  return {bounds.least, bounds.most, along / bounds.most - contact_ * growth_};
}

double RodFlight::overlap_at(double s) const {
  const auto rods = rods_of<Quad>(motion<Quad>(), Ball<Quad>(s));
  return std::max(0.0, contact(s) - distance_of(rods, half_lengths(s)).least) / contact(s);
}

// About when the rods overlap by more than the limit, which they do at `to` and not at `from`.
double RodFlight::crossing(double from, double to, double limit) const {
  for (int i = 0; i < 60; ++i) {
    const double middle = from + 0.5 * (to - from);
    const auto bounds =
        distance_of(rods_of<double>(motion_, Ball<double>(middle)), half_lengths(middle));
    (bounds.most < contact(middle) - limit ? to : from) = middle;
  }
  return to;
}

std::optional<double> RodFlight::overlap(double from, double to) {
  std::vector<Stretch> stretches{{from, to}};
  const double limit = this->limit(to);
  for (; !stretches.empty(); ++looked_at_) {
    const Stretch stretch = stretches.back();
    stretches.pop_back();
    Settled settled = settle(motion_, stretch, limit);
    if (settled.verdict == Verdict::open && !settled.exact) {
      settled = settle(in_quad(), stretch, limit);
    }
    if (settled.verdict == Verdict::free) continue;
    const double middle = stretch.begin + 0.5 * (stretch.end - stretch.begin);
    if (settled.verdict == Verdict::overlapping) return crossing(stretch.begin, middle, limit);
    const bool finest = !(stretch.begin < middle && middle < stretch.end);
    gave_up_ = gave_up_ || finest || looked_at_ >= most_stretches_of_rods;
    if (looked_at_ >= most_stretches_of_rods) return std::nullopt;
    if (finest) continue;
    stretches.push_back({middle, stretch.end});
    stretches.push_back({stretch.begin, middle});
  }
  return std::nullopt;
}

double RodFlight::end_of_overlap(double from, double to) {
  const double limit = this->limit(to);
  for (int i = 60; i > 0; --i) {
    const double s = from + std::ldexp(to - from, -i);
    if (at(s).least > contact(s) - limit) return s;
  }
  return to;
}

}  // namespace needlework::audit
