#include "tests/support/quad_gas.h"

#include <algorithm>
#include <stdexcept>

namespace needlework::test {
namespace {

// Orders of the series, and the longest interval on which one is used, in units of 1 / (|v12| +
// |w1| + |w2|). The remainder is below 0.5^29 / 29! = 2e-40.
constexpr int order = 28;
const Real stretch = Real(1) / 2;

using Series = std::array<Real, order + 1>;

Real rate_of(const PairState& pair) {
  return norm(pair.first.velocity - pair.second.velocity) + norm(pair.first.angular_velocity) +
         norm(pair.second.angular_velocity);
}

// f(t / rate) = sum a_n t^n. u1 x u2 is a sum of four products of sines and cosines; a derivative
// turns their coefficients c + d t.
Series series_of(const PairState& pair, const Real& rate) {
  const auto basis = [&](const NeedleState& needle) -> std::pair<std::array<Vec<Real>, 2>, Real> {
    const Real spin = norm(needle.angular_velocity);
    Vec<Real> side = {Real(0), Real(0), Real(0)};
    if (spin > 0) side = Real(1 / spin) * cross(needle.angular_velocity, needle.orientation);
    return {{needle.orientation, side}, Real(spin / rate)};
  };
  const auto [first, w1] = basis(pair.first);
  const auto [second, w2] = basis(pair.second);
  const Vec<Real> r = pair.first.position - pair.second.position;
  const Vec<Real> v = Real(1 / rate) * (pair.first.velocity - pair.second.velocity);
  std::array<Real, 4> c, d;
  for (int n = 0; n < 4; ++n) {
    const Vec<Real> product = cross(first[n / 2], second[n % 2]);
    c[n] = dot(r, product);
    d[n] = dot(v, product);
  }
  const auto turned = [&, w1 = w1, w2 = w2](const std::array<Real, 4>& a) -> std::array<Real, 4> {
    return {w2 * a[1] + w1 * a[2], w1 * a[3] - w2 * a[0], w2 * a[3] - w1 * a[0],
            -w1 * a[1] - w2 * a[2]};
  };
  Series out;
  Real factorial = 1;
  for (int n = 0; n <= order; ++n) {
    if (n > 0) factorial *= n;
    out[n] = c[0] / factorial;
    c = turned(c);
    for (int j = 0; j < 4; ++j) c[j] += d[j];
    d = turned(d);
  }
  return out;
}

Series shifted(Series a, const Real& by) {
  for (int n = 0; n < order; ++n) {
    for (int m = order - 1; m >= n; --m) a[m] += by * a[m + 1];
  }
  return a;
}

Real value(const Series& a, const Real& t) {
  Real sum = 0;
  for (int n = order; n >= 0; --n) sum = sum * t + a[n];
  return sum;
}

Real slope(const Series& a, const Real& t) {
  Real sum = 0;
  for (int n = order; n >= 1; --n) sum = sum * t + n * a[n];
  return sum;
}

// The root of a monotone series between two ends of different sign, by Newton's method, or by
// halving where that leaves the interval.
Real root_between(const Series& a, Real low, Real high) {
  const bool rises = value(a, high) > 0;
  Real t = (low + high) / 2;
  for (int n = 0; n < 300; ++n) {
    const Real here = value(a, t);
    if (here == 0) break;
    ((here > 0) == rises ? high : low) = t;
    Real next = t - here / slope(a, t);
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (next == t) break;
    t = next;
  }
  return t;
}

// Changes of sign in (begin, end], ascending.
void add_roots(const Series& a, const Real& begin, const Real& end, std::vector<Real>& out) {
  const Real middle = (begin + end) / 2, half = (end - begin) / 2;
  const Series here = shifted(a, middle);
  Real rest = 0, bend = 0;
  for (int n = order; n >= 1; --n) rest = (rest + abs(here[n])) * half;
  for (int n = order; n >= 2; --n) bend = (bend + n * abs(here[n])) * half;
  if (abs(here[0]) > rest) return;
  if (abs(here[1]) > bend) {
    if ((value(here, -half) > 0) == (value(here, half) > 0)) return;
    out.push_back(middle + root_between(here, -half, half));
    return;
  }
  if (half < ldexp(stretch, -100)) throw std::runtime_error("two contacts too close for quad");
  add_roots(a, begin, middle, out);
  add_roots(a, middle, end, out);
}

PairState flown(const PairState& pair, const Real& time) {
  return {flown(pair.first, time), flown(pair.second, time)};
}

// The time until the first contact within a limit.
std::optional<Real> contact_of(const PairState& start, const Real& within, const Real& offset,
                               bool touching) {
  const Real rate = rate_of(start);
  if (rate == 0) return std::nullopt;
  const Real half = Real(1) / 2;
  PairState pair = start;
  for (Real begin = 0; begin < within; begin += stretch / rate) {
    if (begin > 0) pair = flown(start, begin);
    Series series = series_of(pair, rate);
    series[0] += offset;
    if (touching && begin == 0) {
      // f(0) = 0; the root there is divided out.
      std::copy(series.begin() + 1, series.end(), series.begin());
      series.back() = 0;
    }
    std::vector<Real> roots;
    add_roots(series, Real(0), std::min<Real>(stretch, (within - begin) * rate), roots);
    for (const Real& root : roots) {
      const Real after = begin + root / rate;
      const std::array<Real, 2> there = arms(flown(start, after));
      if (abs(there[0]) < half && abs(there[1]) < half) return after;
    }
  }
  return std::nullopt;
}

// a x = b for a symmetric positive definite matrix, by Cramer's rule.
Vec<Real> solved(const std::array<Vec<Real>, 3>& a, const Vec<Real>& b) {
  const Real determinant = dot(a[0], cross(a[1], a[2]));
  return Real(1 / determinant) *
         (b[0] * cross(a[1], a[2]) + b[1] * cross(a[2], a[0]) + b[2] * cross(a[0], a[1]));
}

// An impulse on the first needle at the contact, its negative on the second.
void push_apart(PairState& pair, const Vec<Real>& impulse, double k) {
  const std::array<Real, 2> s = arms(pair);
  const Real inverse_inertia = 2 * Real(k);
  NeedleState &a = pair.first, &b = pair.second;
  a.velocity = a.velocity + impulse;
  b.velocity = b.velocity - impulse;
  a.angular_velocity =
      a.angular_velocity + Real(s[0] * inverse_inertia) * cross(a.orientation, impulse);
  b.angular_velocity =
      b.angular_velocity - Real(s[1] * inverse_inertia) * cross(b.orientation, impulse);
}

Vec<Real> relative_velocity(const PairState& pair) {
  const std::array<Real, 2> s = arms(pair);
  const NeedleState &a = pair.first, &b = pair.second;
  return (a.velocity - b.velocity) + (s[0] * cross(a.angular_velocity, a.orientation) -
                                      s[1] * cross(b.angular_velocity, b.orientation));
}

// Changes V to -epsilon V along the normal and to -beta V across. Source: PHYSICS of the collision
// rule, M dp = V' - V.
void bounce(PairState& pair, const QuadRule& rule, bool elastic) {
  const Real epsilon = elastic ? 1 : rule.epsilon, beta = elastic ? -1 : rule.beta;
  const std::array<Real, 2> s = arms(pair);
  const Vec<Real> normal = contact_normal(pair), v = relative_velocity(pair);
  const Vec<Real> along = dot(v, normal) * normal;
  const Vec<Real> change = Real(-(1 + epsilon)) * along - Real(1 + beta) * (v - along);
  const Vec<Real>&u1 = pair.first.orientation, &u2 = pair.second.orientation;
  const Real m1 = 2 * Real(rule.k) * s[0] * s[0], m2 = 2 * Real(rule.k) * s[1] * s[1];
  std::array<Vec<Real>, 3> mass;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Real one = i == j ? 1 : 0;
      mass[i][j] = 2 * one + m1 * (one - u1[i] * u1[j]) + m2 * (one - u2[i] * u2[j]);
    }
  }
  push_apart(pair, solved(mass, change), rule.k);
}

// The force along the normal, on the first needle, that keeps f'' = 0.
Real reaction(const PairState& pair, double k) {
  const std::array<Real, 2> s = arms(pair);
  const Real sine = norm(cross(pair.first.orientation, pair.second.orientation));
  return -slopes(pair).f2 / sine / (2 + 2 * Real(k) * (s[0] * s[0] + s[1] * s[1]));
}

// Rates of change of the sliding pair, held in the shape of a state.
PairState sliding_rates(const PairState& pair, double k) {
  PairState pushed = pair;
  push_apart(pushed, reaction(pair, k) * contact_normal(pair), k);
  const auto rates = [](const NeedleState& now, const NeedleState& then) -> NeedleState {
    return {now.velocity, cross(now.angular_velocity, now.orientation),
            then.velocity - now.velocity, then.angular_velocity - now.angular_velocity};
  };
  return {rates(pair.first, pushed.first), rates(pair.second, pushed.second)};
}

PairState moved(const PairState& pair, const Real& h, const PairState& rates) {
  const auto needle = [&](const NeedleState& a, const NeedleState& b) -> NeedleState {
    return {a.position + h * b.position, a.orientation + h * b.orientation,
            a.velocity + h * b.velocity, a.angular_velocity + h * b.angular_velocity};
  };
  return {needle(pair.first, rates.first), needle(pair.second, rates.second)};
}

// The classical Runge-Kutta step of order 4.
PairState slid(const PairState& pair, const Real& h, double k) {
  const PairState k1 = sliding_rates(pair, k);
  const PairState k2 = sliding_rates(moved(pair, h / 2, k1), k);
  const PairState k3 = sliding_rates(moved(pair, h / 2, k2), k);
  const PairState k4 = sliding_rates(moved(pair, h, k3), k);
  PairState out = moved(pair, h / 6, k1);
  out = moved(out, h / 3, k2);
  out = moved(out, h / 3, k3);
  return moved(out, h / 6, k4);
}

}  // namespace

std::array<Real, 2> arms(const PairState& pair) {
  const Vec<Real>&u1 = pair.first.orientation, &u2 = pair.second.orientation;
  const Vec<Real> r = pair.first.position - pair.second.position, x = cross(u1, u2);
  const Real xx = dot(x, x);
  return {dot(cross(u2, r), x) / xx, dot(cross(u1, r), x) / xx};
}

Real normal_velocity(const PairState& pair) {
  return dot(relative_velocity(pair), contact_normal(pair));
}

QuadGas::QuadGas(const State& state, const QuadRule& rule)
    : rule_(rule), last_collision_(state.size()) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    needles_.push_back(read(
        {state.position[i], state.orientation[i], state.velocity[i], state.angular_velocity[i]}));
  }
}

Real QuadGas::energy() const {
  Real sum = 0;
  for (const NeedleState& a : needles_) {
    sum += dot(a.velocity, a.velocity) / 2 +
           dot(a.angular_velocity, a.angular_velocity) / (4 * Real(rule_.k));
  }
  return sum;
}

std::optional<QuadGas::Contact> QuadGas::next_contact(const Real& within) const {
  std::optional<Contact> best;
  for (std::size_t i = 0; i < needles_.size(); ++i) {
    for (std::size_t j = i + 1; j < needles_.size(); ++j) {
      const auto offset = offsets_.find({i, j});
      const auto after = contact_of({needles_[i], needles_[j]}, best ? best->after : within,
                                    offset == offsets_.end() ? Real(0) : offset->second,
                                    touching_ == IndexPair(i, j));
      if (after) best = {*after, i, j};
    }
  }
  return best;
}

Real QuadGas::gap(std::size_t i, std::size_t j) const {
  const auto offset = offsets_.find({i, j});
  const Real f = slopes({needles_[i], needles_[j]}).f;
  return offset == offsets_.end() ? f : Real(f + offset->second);
}

QuadCollision QuadGas::strike(std::size_t i, std::size_t j) {
  const auto recent = [&](std::size_t n) {
    return last_collision_[n] && time_ - *last_collision_[n] < rule_.tc;
  };
  PairState pair{needles_[i], needles_[j]};
  const bool elastic = recent(i) || recent(j);
  const QuadCollision out{time_, i, j, arms(pair), normal_velocity(pair), elastic};
  bounce(pair, rule_, elastic);
  std::map<IndexPair, Real> gaps;
  for (std::size_t n = 0; n < needles_.size(); ++n) {
    if (n != i) gaps[std::minmax(n, i)] = gap(std::min(n, i), std::max(n, i));
    if (n != j) gaps[std::minmax(n, j)] = gap(std::min(n, j), std::max(n, j));
  }
  gaps[{i, j}] = 0;
  needles_[i] = rule_.rounded ? read(rounded(pair.first)) : pair.first;
  needles_[j] = rule_.rounded ? read(rounded(pair.second)) : pair.second;
  for (const auto& [who, before] : gaps) {
    offsets_[who] = before - slopes({needles_[who.first], needles_[who.second]}).f;
  }
  last_collision_[i] = last_collision_[j] = time_;
  touching_ = {i, j};
  return out;
}

std::optional<QuadCollision> QuadGas::collide(const Real& until) {
  const auto contact = next_contact(until - time_);
  const Real step = contact ? contact->after : until - time_;
  for (NeedleState& needle : needles_) needle = flown(needle, step);
  time_ += step;
  if (contact) return strike(contact->i, contact->j);
  touching_.reset();
  return std::nullopt;
}

QuadSlide QuadGas::slide(int steps) const {
  PairState pair{needles_.at(0), needles_.at(1)};
  const Real rebound = normal_velocity(pair);
  const int side = rebound > 0 ? 1 : -1;
  QuadRule dead = rule_;
  dead.epsilon = 0;
  dead.beta = -1;
  bounce(pair, dead, false);
  const Real half = Real(1) / 2;
  const auto on_needles = [&](const PairState& at) {
    const std::array<Real, 2> s = arms(at);
    return abs(s[0]) < half && abs(s[1]) < half;
  };
  const auto pushes = [&](const PairState& at) { return reaction(at, rule_.k) * side > 0; };
  const auto holds = [&](const PairState& at) { return on_needles(at) && pushes(at); };
  if (!holds(pair)) throw std::runtime_error("the needles do not slide");
  Real time = time_, h = Real(1) / steps;
  for (PairState next = slid(pair, h, rule_.k); holds(next); next = slid(pair, h, rule_.k)) {
    pair = next;
    time += h;
  }
  // The part of the last step up to the end, by halving.
  Real low = 0, high = h;
  for (int n = 0; n < 100; ++n) {
    const Real middle = (low + high) / 2;
    (holds(slid(pair, middle, rule_.k)) ? low : high) = middle;
  }
  const bool over_a_tip = !on_needles(slid(pair, high, rule_.k));
  pair = slid(pair, low, rule_.k);
  const Real gap = slopes(pair).f / norm(cross(pair.first.orientation, pair.second.orientation));
  return {time + low, over_a_tip, pair, gap, normal_velocity(pair)};
}

}  // namespace needlework::test
