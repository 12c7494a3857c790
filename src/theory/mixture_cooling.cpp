// The cooling of a mixture: the temperatures of each species as functions of time.
#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <numeric>

#include "src/theory/mixture_law.h"
#include "src/theory/requirements.h"

namespace needlework::theory {
namespace {

namespace odeint = boost::numeric::odeint;

// The temperatures of all species, translational and rotational, then the time. Integrated over
// collisions per needle, in which the rates are of one size however much the gas has cooled.
using State = std::vector<double>;

class CoolingMixture {
 public:
  CoolingMixture(const Composition& composition, double volume,
                 std::span<const Temperatures> initial)
      : law_(composition, volume), count_(static_cast<double>(composition.count())) {
    for (const Temperatures& each : initial) state_.insert(state_.end(), {each.t_tr, each.t_rot});
    state_.push_back(0);
  }

  // To a time that is not before the present one.
  void advance(double time) {
    using Stepper = odeint::runge_kutta_dopri5<State>;
    while (state_.back() < time) {
      State next = state_;
      double step = step_, at = 0;
      auto stepper = odeint::make_controlled(tolerance * scale(), tolerance, Stepper());
      const auto by_collisions = [&](const State& state, State& slope, double) {
        differentiate(state, slope, true);
      };
      if (rate() == 0) {
        state_.back() = time;  // nothing happens any more
        return;
      }
      while (stepper.try_step(by_collisions, next, at, step) != odeint::success) {
      }
      if (next.back() > time) {
        finish(time);
        return;
      }
      state_ = next;
      step_ = std::min(step, longest_step);
    }
  }

  std::vector<Temperatures> temperatures() const {
    std::vector<Temperatures> out;
    for (std::size_t n = 0; n + 1 < state_.size(); n += 2) {
      out.push_back({.t_tr = std::max(0.0, state_[n]), .t_rot = std::max(0.0, state_[n + 1])});
    }
    return out;
  }

 private:
  static constexpr double tolerance = 1e-10;
  static constexpr double longest_step = 1;  // of collisions per needle

  double scale() const { return *std::max_element(state_.begin(), state_.end() - 1); }
  double rate() const {
    const MixtureRates rates = law_.rates(temperatures());
    return 2 * std::accumulate(rates.collisions.begin(), rates.collisions.end(), 0.0) / count_;
  }

  // Over collisions per needle, or over time.
  void differentiate(const State& state, State& slope, bool by_collisions) const {
    std::vector<Temperatures> now;
    for (std::size_t n = 0; n + 1 < state.size(); n += 2) {
      // Stages of a step that will be rejected can be below 0.
      now.push_back({.t_tr = std::max(0.0, state[n]), .t_rot = std::max(0.0, state[n + 1])});
    }
    const MixtureRates rates = law_.rates(now);
    const double per_needle =
        2 * std::accumulate(rates.collisions.begin(), rates.collisions.end(), 0.0) / count_;
    const double unit = !by_collisions ? 1 : per_needle > 0 ? 1 / per_needle : 0;
    slope.resize(state.size());
    for (std::size_t n = 0; n < now.size(); ++n) {
      slope[2 * n] = rates.temperatures[n].t_tr * unit;
      slope[2 * n + 1] = rates.temperatures[n].t_rot * unit;
    }
    slope.back() = unit;
  }

  // The rest of the way, which is less than a step, over time.
  void finish(double time) {
    const auto by_time = [&](const State& state, State& slope, double) {
      differentiate(state, slope, false);
    };
    const double from = state_.back();
    odeint::integrate_adaptive(odeint::make_controlled(tolerance * scale(), tolerance,
                                                       odeint::runge_kutta_dopri5<State>()),
                               by_time, state_, from, time, (time - from) / 4);
    state_.back() = time;
  }

  MixtureLaw law_;
  double count_;
  State state_;
  double step_ = 1e-3;
};

}  // namespace

MixtureRates mixture_rates(const Composition& composition, double volume,
                           std::span<const Temperatures> now) {
  return MixtureLaw(composition, volume).rates(now);
}

std::vector<std::vector<Temperatures>> mixture_cooling(const Composition& composition,
                                                       double volume,
                                                       std::span<const Temperatures> initial,
                                                       std::span<const double> times) {
  require(initial.size() == composition.size(), "initial", static_cast<double>(initial.size()),
          "temperatures of each species");
  for (const Temperatures& each : initial) require_valid(each);
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  CoolingMixture mixture(composition, volume, initial);
  std::vector<std::vector<Temperatures>> out(times.size());
  for (const std::size_t n : order) {
    require_not_negative("time", times[n]);
    mixture.advance(times[n]);
    out[n] = mixture.temperatures();
  }
  return out;
}

}  // namespace needlework::theory
