// Correlation in time of displacement, rotation and velocities, at lags from one sample to very
// many, as means over all needles. With u(t) the director, P(t) = 1 - u(t) u(t) and r followed
// across the boundaries, for each lag the state then and now:
//
//   lag                     t - t0
//   parallel                ((r(t) - r(t0)) . u(t0))^2
//   perpendicular           |r(t) - r(t0)|^2 less the above: both directions across
//   p1                      u(t) . u(t0)
//   p2                      (3 (u(t) . u(t0))^2 - 1) / 2
//   velocity                v(t) . v(t0)
//   velocity_parallel       (v(t) . u(t)) (v(t0) . u(t0))
//   velocity_perpendicular  P(t) v(t) . P(t0) v(t0)
//   angular_velocity        w(t) . w(t0)
//
// Lags in samples are 0 to 8 and then 10, 12, 14, 16, 20, 24, ..., four for each doubling: 5 to 8
// times a power of 2. A lag of m times 2^l, m >= 5, is measured at every 2^l-th sample, where both
// ends are multiples of 2^l; its place has NaN at the others. So each lag has as many starting
// times as a run of equal steps has room for, evenly spread, and a mean over the rows is the
// correlation function. Blocks of rows give its error.
//
// Of the samples so far, number s stays until it is 8 times the largest power of 2 in s old, so
// that there are about 4 for each doubling of their number.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "src/observe/moved.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

constexpr const char* speed_squared = "length squared per time squared";
constexpr const char* angular_speed_squared = "radians squared per time squared";

constexpr std::size_t levels = 14;                               // of doubling
constexpr std::size_t farthest = 8, nearest = farthest / 2 + 1;  // lags of a level, in its steps

struct LagInSamples {
  std::uint64_t samples, every;  // measured at multiples of `every`
};

constexpr auto lags_in_samples = [] {
  std::array<LagInSamples, 1 + farthest + (levels - 1) * (farthest - nearest + 1)> out{};
  std::size_t n = 0;
  for (std::uint64_t lag = 0; lag <= farthest; ++lag) out[n++] = {lag, 1};
  for (std::size_t level = 1; level < levels; ++level)
    for (std::uint64_t lag = nearest; lag <= farthest; ++lag) {
      out[n++] = {lag << level, std::uint64_t{1} << level};
    }
  return out;
}();

struct Then {
  std::uint64_t sample;  ///< its number, counted from 0
  double time;
  std::vector<Vector> position, orientation, velocity, angular_velocity;
};

void transfer(Archive& archive, Then& then) {
  archive(then.sample, then.time, then.position, then.orientation, then.velocity,
          then.angular_velocity);
}

/// Whether a sample is still the earlier end of a lag at sample `now` or later.
bool is_needed(std::uint64_t sample, std::uint64_t now) {
  const int level = sample == 0 ? levels - 1 : std::min<int>(std::countr_zero(sample), levels - 1);
  return now - sample <= farthest << level;
}

/// Of so many samples.
std::size_t needed_of(std::uint64_t samples) {
  if (samples == 0) return 0;
  const std::uint64_t last = samples - 1;
  std::uint64_t out = 0;
  for (std::size_t level = 0; level < levels; ++level) {
    const std::uint64_t first = last - std::min<std::uint64_t>(last, farthest << level);
    const auto multiples = [&](std::uint64_t of) { return last / of - (first + of - 1) / of + 1; };
    out += multiples(std::uint64_t{1} << level);
    if (level + 1 < levels) out -= multiples(std::uint64_t{2} << level);
  }
  return out;
}

class TimeCorrelation : public Observable {
 public:
  explicit TimeCorrelation(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override {
    const std::vector<SeriesField::Extent> shape{{"lags", lags_in_samples.size()}};
    std::vector<double> samples;
    samples.reserve(lags_in_samples.size());
    for (const LagInSamples& lag : lags_in_samples) {
      samples.push_back(static_cast<double>(lag.samples));
    }
    return {
        {"samples", "Each lag in samples", unit::none, shape, SeriesField::Kind::constant, samples},
        {"lag", "Time since the earlier state of each lag", unit::time, shape},
        {"parallel", "Mean square displacement along the orientation then", unit::area, shape},
        {"perpendicular", "Mean square displacement across the orientation then", unit::area,
         shape},
        {"p1", "Mean cosine of the angle between the orientations then and now", unit::none, shape},
        {"p2", "Mean of (3 cos^2 - 1) / 2 of the same angle", unit::none, shape},
        {"velocity", "Mean product of the velocities then and now", speed_squared, shape},
        {"velocity_parallel",
         "Mean product of their components along the orientations then and now", speed_squared,
         shape},
        {"velocity_perpendicular",
         "Mean product of their parts across the orientations then and now", speed_squared, shape},
        {"angular_velocity", "Mean product of the angular velocities then and now",
         angular_speed_squared, shape},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    const std::uint64_t number = samples_++;
    std::erase_if(kept_, [&](const Then& then) { return !is_needed(then.sample, number); });
    kept_.push_back({number, now.totals.time, unwrapped(now.state), now.state.orientation,
                     now.state.velocity, now.state.angular_velocity});
    std::vector<Means> means;
    for (const LagInSamples& lag : lags_in_samples) {
      const bool is_due = number % lag.every == 0 && number >= lag.samples;
      means.push_back(is_due ? since(number - lag.samples) : Means{});
    }
    for (double Means::*mean : {&Means::lag, &Means::parallel, &Means::perpendicular, &Means::p1,
                                &Means::p2, &Means::velocity, &Means::velocity_parallel,
                                &Means::velocity_perpendicular, &Means::angular_velocity}) {
      for (const Means& each : means) row.put(each.*mean);
    }
  }

  void transfer(Archive& archive) override {
    archive(samples_, kept_);
    // Those that are needed, and no others, in their order.
    archive.require(kept_.size() == needed_of(samples_));
    for (std::size_t n = 0; n < kept_.size(); ++n) {
      const Then& then = kept_[n];
      archive.require(then.sample < samples_ && is_needed(then.sample, samples_ - 1) &&
                      (n == 0 || kept_[n - 1].sample < then.sample) && std::isfinite(then.time));
      for (const std::vector<Vector>* column :
           {&then.position, &then.orientation, &then.velocity, &then.angular_velocity}) {
        archive.require(column->size() == gas_.count);
      }
    }
  }

 private:
  struct Means {
    double lag = std::numeric_limits<double>::quiet_NaN();
    double parallel = lag, perpendicular = lag, p1 = lag, p2 = lag;
    double velocity = lag, velocity_parallel = lag, velocity_perpendicular = lag;
    double angular_velocity = lag;
  };

  /// Of the state at a sample, which is kept, and the last one.
  Means since(std::uint64_t sample) const {
    const Then& then = *std::ranges::lower_bound(kept_, sample, {}, &Then::sample);
    const Then& now = kept_.back();
    const Moved way = moved(then.position, then.orientation, now.position, now.orientation);
    double velocity = 0, parallel = 0, perpendicular = 0, angular = 0;
    for (std::size_t i = 0; i < now.position.size(); ++i) {
      const Vector &u0 = then.orientation[i], &u = now.orientation[i];
      const Vector &v0 = then.velocity[i], &v = now.velocity[i];
      const double vv = dot(v, v0), along = dot(v, u), along0 = dot(v0, u0);
      velocity += vv;
      parallel += along * along0;
      perpendicular += vv - along0 * dot(v, u0) - along * dot(v0, u) + along * along0 * dot(u, u0);
      angular += dot(now.angular_velocity[i], then.angular_velocity[i]);
    }
    const double count = static_cast<double>(now.position.size());
    Means out;
    out.lag = now.time - then.time;
    out.parallel = way.parallel, out.perpendicular = way.perpendicular;
    out.p1 = way.p1, out.p2 = way.p2;
    out.velocity = velocity / count, out.velocity_parallel = parallel / count;
    out.velocity_perpendicular = perpendicular / count, out.angular_velocity = angular / count;
    return out;
  }

  GasSetting gas_;
  std::uint64_t samples_ = 0;
  std::vector<Then> kept_;  ///< in order of their numbers
};

}  // namespace

ObservablePointer make_time_correlation(const GasSetting& gas) {
  return std::make_unique<TimeCorrelation>(gas);
}

}  // namespace needlework::observe
