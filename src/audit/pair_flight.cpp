#include "src/audit/pair_flight.h"

#include <algorithm>
#include <cmath>

#include "src/audit/relative_motion.h"

namespace needlework::audit {
namespace {

/// Half a unit in the last place of 1.
constexpr double half_unit = 0x1p-53;
/// For numbers below this, and their products, the engine's double-double arithmetic loses digits.
/// [L]
constexpr double underflow = 0x1p-960;

template <class Real>
Sample evaluate(const Flight<Ball<Real>>& first, const Flight<Ball<Real>>& second,
                const std::array<Ball<Real>, 2>& delay, const Vector<double>& shift,
                const std::array<double, 3>& box, const std::array<double, 2>& half_lengths,
                double offset, double slope, double s) {
  using Number = Ball<Real>;
  const Number t1 = delay[0] + Number(s), t2 = delay[1] + Number(s);
  const Pose<Number> a = first.at(t1), b = second.at(t2);
  const Vector<Number> r = separation(first, second, t1, t2, shift, box);
  const Vector<Number> x = cross(a.u, b.u);
  const Vector<Number> dx = cross(a.du, b.u) + cross(a.u, b.du);
  const Number f = dot(r, x) - (Number(offset) + Number(slope) * Number(s));
  const Number df = dot(first.v - second.v, x) + dot(r, dx) - Number(slope);

  Sample out;
  out.f = static_cast<double>(f.middle);
  out.f_error = f.radius + half_unit * (std::abs(out.f) + std::abs(offset) + std::abs(slope * s));
  out.df = static_cast<double>(df.middle);
  out.df_error = df.radius + half_unit * (std::abs(out.df) + std::abs(slope));
  out.distance = upper(norm(r));
  const Number xx = dot(x, x);
  out.sine = upper(sqrt(xx));
  const std::array<Vector<Number>, 2> moments = {cross(b.u, r), cross(a.u, r)};
  for (int i = 0; i < 2; ++i) {
    const Number moment = norm(moments[i]);
    out.moment_least[i] = lower(moment);
    out.moment_most[i] = upper(moment);
    const Number along = dot(moments[i], x);
    const Number margin = xx * Number(half_lengths[i]) - (along.middle < 0 ? -along : along);
    out.margin[i] = static_cast<double>(margin.middle);
    out.margin_error[i] = margin.radius + half_unit * std::abs(out.margin[i]);
  }
  return out;
}

}  // namespace

PairFlight::PairFlight(const Needle& first, const Needle& second, const Shift& shift,
                       const Space& space, const Start& start)
    : PairMotion(first.body, second.body, space.around(first.record.r).around(second.record.r),
                 start),
      first_(first),
      second_(second),
      flights_{first.flight, second.flight},
      shift_{{double(shift[0]), double(shift[1]), double(shift[2])}} {
  const Instant begin = std::max(first.record.time, second.record.time);
  delay_ = {elapsed<double>(first.record.time, begin), elapsed<double>(second.record.time, begin)};
  for (std::size_t i = 0; i < 2; ++i) {
    flights_[i] = without_gravity(flights_[i], space.gravity, delay_[i]);
  }
  omega_ = {upper(first.flight.omega), upper(second.flight.omega)};
  // With what gravity adds to them, or takes away, since the record.
  for (std::size_t i = 0; i < 2; ++i) {
    const Record& record = i == 0 ? first.record : second.record;
    velocity_[i] = (norm(record.v) + 2 * norm(space.gravity) * upper(delay_[i])) * upward;
  }
  speed_ = upper(norm(flights_[0].v - flights_[1].v));
  spin_ = omega_[0] + omega_[1];
  distance_ = sample(0).distance;
  if (start.kind == Start::collided) {
    const Sample e = precise(0);
    offset_ = e.f;
    // Centres close to each other lose digits of their separation vector in new records, which
    // changes f'.
    const double rounding =
        space.rounding() * (speed_ + spin_) + 4 * half_unit * (velocity_[0] + velocity_[1]);
    if (e.df * start.side < 0 && std::abs(e.df) <= rounding) slope_ = e.df;
  } else if (start.gap) {
    offset_ = precise(0).f - *start.gap;
  }
}

Sample PairFlight::sample(double s) const {
  return evaluate(flights_[0], flights_[1], delay_, shift_, space_.box, half_lengths_, offset_,
                  slope_, s);
}

const PairFlight::Precise& PairFlight::in_quad() {
  if (!precise_) {
    const Instant begin = std::max(first_.record.time, second_.record.time);
    const std::array delay = {elapsed<Quad>(first_.record.time, begin),
                              elapsed<Quad>(second_.record.time, begin)};
    const auto flight = [&](const Needle& needle, std::size_t i) {
      return without_gravity(needle.flight_as<Ball<Quad>>(), space_.gravity, delay[i]);
    };
    precise_.emplace(Precise{flight(first_, 0), flight(second_, 1), delay});
  }
  return *precise_;
}

Sample PairFlight::precise(double s) {
  const auto& [first, second, delay] = in_quad();
  return evaluate(first, second, delay, shift_, space_.box, half_lengths_, offset_, slope_, s);
}

// f is the sum of (r12(0) + v12 s) . (a x b) c1(s) c2(s). If c1 is the cosine of the first
// needle's angle since its record, a is its director in the record; if c1 is the sine, a is the
// direction to which it turns. The same holds for b, c2 and the second needle.
void PairFlight::find_coefficients() {
  if (coefficients_) return;
  const auto& [first, second, delay] = in_quad();
  const auto r = separation(first, second, delay[0], delay[1], shift_, space_.box);
  const auto v = first.v - second.v;
  const std::array a = {first.u, first.side}, b = {second.u, second.side};
  coefficients_.emplace();
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const auto x = cross(a[i], b[j]);
      (*coefficients_)[i][j] = {upper(dot(r, x)), upper(dot(v, x))};
    }
  }
}

double PairFlight::bend(double begin, double end, double distance) const {
  const double general = (2 * speed_ + distance * spin_) * spin_;
  if (!coefficients_) return general * upward;
  const double latest = std::max(std::abs(begin), std::abs(end));
  // Bounds on cosine and sine, and on their derivatives.
  const auto [w1, w2] = omega_;
  const double sine1 = std::min(1.0, w1 * (upper(delay_[0]) + latest));
  const double sine2 = std::min(1.0, w2 * (upper(delay_[1]) + latest));
  const std::array size1 = {1.0, sine1}, size2 = {1.0, sine2};
  const std::array rate1 = {w1 * sine1, w1}, rate2 = {w2 * sine2, w2};
  double special = 0;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const auto& [constant, linear] = (*coefficients_)[i][j];
      const double curved = (w1 * w1 + w2 * w2) * size1[i] * size2[j] + 2 * rate1[i] * rate2[j];
      const double sloped = rate1[i] * size2[j] + size1[i] * rate2[j];
      special += (constant + linear * latest) * curved + 2 * linear * sloped;
    }
  }
  return std::min(general * upward, special * (1 + 0x1p-40));
}

PairFlight::Uncertainty PairFlight::uncertainty(double s) const {
  // Lengths whose rounding matters: the separation at s = 0, including the flight of the older
  // record until then, and the flight since.
  Uncertainty out{0, {}, distance_ + speed_ * std::abs(s)};
  bool renewed = space_.rounds();  // sooner than others
  for (int i = 0; i < 2; ++i) {
    const double delay = upper(delay_[i]), age = delay + std::abs(s);
    out.lengths += velocity_[i] * delay;
    out.directors[i] = half_unit * (2 + omega_[i] * age);
    const double lengths = velocity_[i] * age / (2 * half_lengths_[i]);
    renewed = renewed || lengths > longest_record || omega_[i] * age > longest_record;
  }
  out.distance = half_unit * (out.lengths + speed_ * std::abs(s));
  if (renewed) out.distance += space_.rounding();
  return out;
}

double PairFlight::limit(const Sample& sample, double s, double half) const {
  const Uncertainty by = uncertainty(std::abs(s) + half);
  double sum = by.distance * std::min(1.0, sample.sine + spin_ * half);
  for (int i = 0; i < 2; ++i) {
    const double moment = sample.moment_most[i] + moment_rate(i, 1 + speed_ * half) * half;
    sum += by.directors[i] * std::min(moment, sample.distance + speed_ * half);
  }
  sum += 2 * half_unit * by.lengths;
  // Errors that both evaluations share cancel in f(s) - f(0).
  if (start_.kind == Start::collided) {
    sum *= std::min(1.0, 4 * rate() * (std::abs(s) + half));
  }
  sum += start_.gap_error + underflow;
  return sum;
}

bool PairMotion::is_near_contact(double s) const {
  const Sample e = sample(s);
  const double least = -beside * size() * e.sine;
  return std::abs(e.f) <= space_.continued() && e.margin[0] >= least && e.margin[1] >= least;
}

double PairFlight::margin_limit(const Sample& sample, double s) const {
  const Uncertainty by = uncertainty(s);
  const double directors = by.directors[0] + by.directors[1];
  const double moment = std::max(sample.moment_most[0], sample.moment_most[1]);
  return 4 * (sample.sine * (by.distance + directors * (1 + sample.distance)) + moment * directors);
}

}  // namespace needlework::audit
