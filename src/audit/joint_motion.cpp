#include "src/audit/joint_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "src/audit/tolerances.h"

namespace needlework::audit {
namespace {

/// Relative error that a step leaves over, by the size of its last terms.
constexpr double truncation = 0x1p-66;
/// A contact of more steps cannot be resolved.
constexpr std::size_t most_steps = 4000;
/// What halving does at most to an interval of time.
constexpr int deepest = 52;
/// Relative uncertainty of the numbers at the beginning: what the engine rounds in its steps, too.
constexpr double uncertain = 0x1p-49;
/// Neighbours begin so many times farther away, so that their distance has digits.
constexpr double magnified = 0x1p10;
/// By the bits of each, 18 numbers at the beginning of a neighbour are larger or smaller.
constexpr std::array<std::uint32_t, 3> aside = {0x2d1a7, 0x1b8e5, 0x34c6b};

template <class Series>
Extended value(const Series& a, Extended t) {
  Extended sum = 0;
  for (std::size_t k = a.size(); k-- > 0;) sum = sum * t + a[k];
  return sum;
}

template <class Series>
Extended slope(const Series& a, Extended t) {
  Extended sum = 0;
  for (std::size_t k = a.size(); k-- > 1;) sum = sum * t + static_cast<Extended>(k) * a[k];
  return sum;
}

/// Bound on the n-th derivative (n = 1 or 2) for times up to t.
template <class Series>
double most_of(const Series& a, int n, Extended t) {
  Extended sum = 0, power = 1;
  for (std::size_t k = static_cast<std::size_t>(n); k < a.size(); ++k) {
    const Extended factor = n == 1 ? static_cast<Extended>(k) : static_cast<Extended>(k * (k - 1));
    sum += factor * std::abs(a[k]) * power;
    power *= t;
  }
  return static_cast<double>(sum) * upward;
}

template <class VectorSeries>
Vector<Extended> value_of(const VectorSeries& a, Extended t) {
  return {{value(a[0], t), value(a[1], t), value(a[2], t)}};
}

template <class VectorSeries>
Vector<Extended> slope_of(const VectorSeries& a, Extended t) {
  return {{slope(a[0], t), slope(a[1], t), slope(a[2], t)}};
}

template <class VectorSeries>
double most_of_vector(const VectorSeries& a, int n, Extended t) {
  const double x = most_of(a[0], n, t), y = most_of(a[1], n, t), z = most_of(a[2], n, t);
  return std::sqrt(x * x + y * y + z * z) * upward;
}

/// The coefficient of order k of a product.
template <class Series>
Extended product(const Series& a, const Series& b, int k) {
  Extended sum = 0;
  for (int i = 0; i <= k; ++i) sum += a[i] * b[k - i];
  return sum;
}

template <class VectorSeries>
Extended dot_product(const VectorSeries& a, const VectorSeries& b, int k) {
  return product(a[0], b[0], k) + product(a[1], b[1], k) + product(a[2], b[2], k);
}

template <class VectorSeries>
void add_cross(VectorSeries& out, const VectorSeries& a, const VectorSeries& b, int k) {
  for (int axis = 0; axis < 3; ++axis) {
    const int y = (axis + 1) % 3, z = (axis + 2) % 3;
    out[axis][k] += product(a[y], b[z], k) - product(a[z], b[y], k);
  }
}

}  // namespace

JointMotion::JointMotion(const RelativeState& begin, const std::array<AuditedBody, 2>& bodies,
                         int side)
    : bodies_(bodies), side_(side), apart_(begin.r), last_(begin) {
  const Extended m1 = bodies[0].mass, m2 = bodies[1].mass, mass = m1 + m2;
  share_ = {m2 / mass, m1 / mass};
  inverse_mass_ = 1 / m1 + 1 / m2;
  for (std::size_t i = 0; i < 2; ++i) inverse_inertia_[i] = bodies_[i].inverse_inertia<Extended>();
}

JointMotion::JointMotion(const Needle& first, const Needle& second, const Vector<double>& r12,
                         int side, double rounding)
    : JointMotion(relative_state(first.record, second.record, r12), {first.body, second.body},
                  side) {
  centre_ = {to<Extended>(first.record.r), to<Extended>(second.record.r)};
  drift_ = to<Extended>(first.record.v) * share_[1] + to<Extended>(second.record.v) * share_[0];
  add_neighbours(rounding);
}

// Of the velocities, what rounding has added to f' is taken off, as the engine does after each
// step.
void JointMotion::add_neighbours(double rounding) {
  const RelativeState begin = last_;
  const Touch touch(begin, bodies_);
  const Extended length = (Extended(bodies_[0].length) + bodies_[1].length) / 2;
  const Extended speed = touch.speeds + norm(drift_);
  const auto spin = [&](const Vector<Extended>& du, std::size_t i) {
    return norm(du) + share_[i] * bodies_[i].k / bodies_[i].length * touch.speeds;
  };
  const std::array scales = {length + rounding / uncertain,
                             speed,
                             Extended(1),
                             spin(begin.du1, 0),
                             Extended(1),
                             spin(begin.du2, 1)};
  for (std::uint32_t signs : aside) {
    RelativeState state = begin;
    const std::array parts = {&state.r, &state.v, &state.u1, &state.du1, &state.u2, &state.du2};
    for (std::size_t i = 0; i < parts.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis, signs >>= 1) {
        (*parts[i])[axis] += (signs & 1 ? 1 : -1) * magnified * uncertain * scales[i];
      }
    }
    for (const auto& [u, du] : {std::pair(&state.u1, &state.du1), {&state.u2, &state.du2}}) {
      *u = *u * (1 / norm(*u));
      *du = *du - *u * dot(*u, *du);
    }
    const Touch moved(state, bodies_);
    neighbours_.emplace_back(after_change(state, bodies_, moved, -moved.normal_velocity), bodies_,
                             side_);
  }
}

double JointMotion::spread(int needle, double s) const {
  const RelativeState here = state_at(s);
  const AuditedBody& body = bodies_[needle];
  const Extended speeds = Touch(here, bodies_).speeds, share = share_[needle];
  Extended most = 0;
  for (const JointMotion& each : neighbours_) {
    const RelativeState there = each.state_at(s);
    const bool first = needle == 0;
    const Extended turned = norm(first ? there.u1 - here.u1 : there.u2 - here.u2);
    most = std::max({most, norm(there.r - here.r) * share / body.length, turned});
    if (!(speeds > 0)) continue;
    const Extended faster = norm(first ? there.du1 - here.du1 : there.du2 - here.du2);
    most = std::max({most, norm(there.v - here.v) * share / speeds,
                     faster * body.length / (2 + body.k) / speeds});
  }
  return static_cast<double>(most) / magnified;
}

bool JointMotion::follow(double until) {
  while (!(known_ > until)) {
    if (is_lost_) return false;
    Step step = step_from(last_, known_);
    const double span = step.span;
    const double turned = static_cast<double>(Touch(last_, bodies_).rate) * span;
    if (!steps_.empty()) step.grown = steps_.back().grown;
    if (std::isfinite(turned)) step.grown += turned;
    is_lost_ = !(known_ + span > known_) || steps_.size() >= most_steps;
    // There is always one step, so that places can be asked for.
    if (is_lost_ && !steps_.empty()) return false;
    steps_.push_back(step);
    if (is_lost_) return false;
    if (std::isfinite(span)) last_ = state_at(known_ + span);
    known_ += span;
  }
  return std::ranges::all_of(neighbours_, [&](JointMotion& each) { return each.follow(until); });
}

JointMotion::Step JointMotion::step_from(const RelativeState& state, double begin) const {
  Step out;
  out.begin = begin;
  VectorSeries &r = out.r, &u1 = out.u1, &u2 = out.u2;
  VectorSeries dr{}, du1{}, du2{}, x{}, dx{}, g1{}, g2{}, turned{};
  Series xx{}, spin1{}, spin2{}, mass{}, bent{}, mu{}, along1{}, along2{};
  for (int axis = 0; axis < 3; ++axis) {
    r[axis][0] = state.r[axis], r[axis][1] = state.v[axis];
    u1[axis][0] = state.u1[axis], u1[axis][1] = state.du1[axis];
    u2[axis][0] = state.u2[axis], u2[axis][1] = state.du2[axis];
  }
  for (int k = 0; k <= order; ++k) {
    // What follows from the coefficients of places up to k, and of their rates.
    add_cross(x, u1, u2, k);
    add_cross(g1, u2, r, k);
    add_cross(g2, r, u1, k);
    xx[k] = dot_product(x, x, k);
    along1[k] = dot_product(g1, x, k);   // s12 |x|^2
    along2[k] = -dot_product(g2, x, k);  // s21 |x|^2
    if (k > order - 2) continue;
    for (int axis = 0; axis < 3; ++axis) {
      dr[axis][k] = static_cast<Extended>(k + 1) * r[axis][k + 1];
      du1[axis][k] = static_cast<Extended>(k + 1) * u1[axis][k + 1];
      du2[axis][k] = static_cast<Extended>(k + 1) * u2[axis][k + 1];
    }
    add_cross(dx, du1, u2, k);
    add_cross(dx, u1, du2, k);
    add_cross(turned, du1, du2, k);
    spin1[k] = dot_product(du1, du1, k);
    spin2[k] = dot_product(du2, du2, k);
    mass[k] = inverse_mass_ * xx[k] + inverse_inertia_[0] * dot_product(g1, g1, k) +
              inverse_inertia_[1] * dot_product(g2, g2, k);
    bent[k] = 2 * (dot_product(dr, dx, k) + dot_product(r, turned, k));
    Extended rest = -bent[k];
    for (int i = 1; i <= k; ++i) rest -= mass[i] * mu[k - i];
    mu[k] = rest / mass[0];
    const Extended both = static_cast<Extended>((k + 1) * (k + 2));
    for (int axis = 0; axis < 3; ++axis) {
      r[axis][k + 2] = inverse_mass_ * product(mu, x[axis], k) / both;
      u1[axis][k + 2] =
          (inverse_inertia_[0] * product(mu, g1[axis], k) - product(spin1, u1[axis], k)) / both;
      u2[axis][k + 2] =
          (inverse_inertia_[1] * product(mu, g2[axis], k) - product(spin2, u2[axis], k)) / both;
    }
  }
  const std::array<Extended, 2> half = {bodies_[0].length / Extended(2),
                                        bodies_[1].length / Extended(2)};
  for (int k = 0; k <= order; ++k) {
    out.room[0][k] = k <= order - 2 ? -side_ * bent[k] : 0;
    out.room[1][k] = half[0] * xx[k] - along1[k];
    out.room[2][k] = half[0] * xx[k] + along1[k];
    out.room[3][k] = half[1] * xx[k] - along2[k];
    out.room[4][k] = half[1] * xx[k] + along2[k];
  }
  const Extended omega = norm(state.du1) + norm(state.du2);
  out.force_scale = (2 * norm(state.v) + norm(state.r) * omega) * omega;

  // The last terms of all series, those of the rooms too, are below rounding.
  double span = HUGE_VAL;
  const auto limit = [&](const Series& a, Extended scale, int last) {
    for (int k = last - 1; k <= last; ++k) {
      const Extended size = std::abs(a[k]);
      if (!(size <= HUGE_VALL)) span = 0;  // NaN too
      if (!(size > 0)) continue;
      const Extended step = std::pow(scale * truncation / size, Extended(1) / k);
      span = std::min(span, static_cast<double>(step));
    }
  };
  const Extended length = half[0] + half[1];
  for (int axis = 0; axis < 3; ++axis) {
    limit(r[axis], length, order);
    limit(u1[axis], 1, order);
    limit(u2[axis], 1, order);
  }
  for (int n = 1; n < rooms; ++n) limit(out.room[n], half[n > 2] * xx[0], order);
  if (out.force_scale > 0) limit(out.room[0], out.force_scale, order - 2);
  out.span = span;
  return out;
}

const JointMotion::Step& JointMotion::step_at(double s) const {
  const auto after =
      std::upper_bound(steps_.begin(), steps_.end(), s,
                       [](double time, const Step& step) { return time < step.begin; });
  return after == steps_.begin() ? steps_.front() : *(after - 1);
}

RelativeState JointMotion::state_at(double s) const {
  const Step& step = step_at(s);
  const Extended t = Extended(s) - step.begin;
  return {value_of(step.r, t),  slope_of(step.r, t),  value_of(step.u1, t),
          slope_of(step.u1, t), value_of(step.u2, t), slope_of(step.u2, t)};
}

BodyState JointMotion::at(int needle, double s) const {
  const RelativeState state = state_at(s);
  const Extended part = needle == 0 ? share_[0] : -share_[1];
  BodyState out;
  out.r = centre_[needle] + drift_ * Extended(s) + (state.r - apart_) * part;
  out.v = drift_ + state.v * part;
  out.u = needle == 0 ? state.u1 : state.u2;
  out.du = needle == 0 ? state.du1 : state.du2;
  return out;
}

JointMotion::Most JointMotion::most(int needle, double begin, double end) const {
  Most out;
  const double part = static_cast<double>(share_[needle]),
               drift = static_cast<double>(norm(drift_));
  for (const Step* step = &step_at(begin); step != steps_.data() + steps_.size(); ++step) {
    if (step->begin > end) break;
    const Extended t = std::min(end - step->begin, step->span);
    const VectorSeries& u = needle == 0 ? step->u1 : step->u2;
    out.speed = std::max(out.speed, (drift + part * most_of_vector(step->r, 1, t)) * upward);
    out.acceleration = std::max(out.acceleration, part * most_of_vector(step->r, 2, t) * upward);
    out.turning = std::max(out.turning, most_of_vector(u, 1, t));
    // |w'| is at most |u''|, of which it is the part normal to u.
    out.turned_faster = std::max(out.turned_faster, most_of_vector(u, 2, t));
  }
  return out;
}

double JointMotion::noise_of(int room, double s) const {
  const Step& step = step_at(s);
  const auto value_at = [&](const Step& of) {
    return value(of.room[room], Extended(s) - of.begin);
  };
  double out = 0;
  for (const JointMotion& each : neighbours_) {
    const Extended apart = value_at(each.step_at(s)) - value_at(step);
    out = std::max(out, static_cast<double>(std::abs(apart)) / magnified);
  }
  return out + contact_noise *
                   (room == 0 ? static_cast<double>(step.force_scale) : bodies_[room > 2].length);
}

std::array<JointMotion::Room, JointMotion::rooms> JointMotion::rooms_at(double s) const {
  const Step& step = step_at(s);
  const Extended t = Extended(s) - step.begin;
  std::array<Room, rooms> out;
  for (int n = 0; n < rooms; ++n) {
    out[n] = {static_cast<double>(value(step.room[n], t)),
              static_cast<double>(slope(step.room[n], t)), noise_of(n, s), n == 0};
  }
  return out;
}

// The first time in [low, high] of the step, as times since its begin, at which the series is below
// the level.
std::optional<double> JointMotion::below(const Step& step, const Series& room, Extended level,
                                         double low, double high, int depth) const {
  const double half = 0.5 * (high - low), middle = low + half;
  const Extended above = value(room, middle) - level;
  const double most = most_of(room, 2, high);
  const double change =
      (static_cast<double>(std::abs(slope(room, middle))) + 0.5 * most * half) * half * upward;
  if (above >= change) return std::nullopt;
  if (depth == deepest) return above < 0 ? std::optional(middle) : std::nullopt;
  if (const auto sooner = below(step, room, level, low, middle, depth + 1)) return sooner;
  return below(step, room, level, middle, high, depth + 1);
}

std::optional<double> JointMotion::first_below(double noises, double from, double to) const {
  for (const Step& step : steps_) {
    if (step.begin + step.span < from) continue;
    if (step.begin > to) break;
    const double low = std::max(0.0, from - step.begin),
                 high = std::min(step.span, to - step.begin);
    std::optional<double> first;
    for (int n = 0; n < rooms; ++n) {
      const auto found = below(step, step.room[n], noises * noise_of(n, step.begin + high), low,
                               first.value_or(high), 0);
      if (found) first = found;
    }
    if (first) return step.begin + *first;
  }
  return std::nullopt;
}

}  // namespace needlework::audit
