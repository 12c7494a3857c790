// The cooling of a mixture: the temperatures of each species as functions of time.
#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "needlework/error.h"
#include "src/theory/mixture_law.h"
#include "src/theory/requirements.h"

namespace needlework::theory {
namespace {

namespace odeint = boost::numeric::odeint;

// The temperatures of all species, translational and rotational, then the time and the collisions
// per needle. Integrated over the latter, in which the rates are of one size however much the gas
// has cooled.
using MixtureState = std::vector<double>;

}  // namespace

struct MixtureCurve::Implementation {
  Implementation(const Composition& composition, double volume,
                 std::span<const Temperatures> initial, std::vector<double> contact)
      : law_(composition, volume, std::move(contact)),
        count_(static_cast<double>(composition.count())) {
    for (const Temperatures& each : initial) state_.insert(state_.end(), {each.t_tr, each.t_rot});
    state_.insert(state_.end(), {0, 0});
  }

  // To a time that is not before the present one.
  void advance(double end) {
    while (time() < end && !is_lost()) {
      MixtureState slope;
      const double rate = differentiate(state_, slope, false);
      if (rate == 0) {
        time() = end;  // nothing happens any more
      } else if (const auto loss = common_loss(slope, rate)) {
        follow_haffs_law(end, *loss, rate);
      } else if (rate * (end - time()) <= step_ || !step_by_collisions(end)) {
        finish(end);
      }
    }
  }

  std::vector<Temperatures> temperatures() const {
    if (is_lost()) return std::vector<Temperatures>(state_.size() / 2 - 1, {undefined, undefined});
    return temperatures_of(state_);
  }

  double collisions() const { return is_lost() ? undefined : state_.back(); }

  std::vector<double> place() const {
    std::vector<double> out = state_;
    out.insert(out.end(), {step_, static_cast<double>(steps_)});
    return out;
  }
  void go_to(std::span<const double> place) {
    const std::size_t size = state_.size();
    const bool possible =
        place.size() == size + 2 &&
        std::ranges::all_of(place, [](double value) { return std::isfinite(value); }) &&
        place[size - 2] >= 0 && place[size - 1] >= 0 && place[size] > 0 && place[size + 1] >= 0 &&
        place[size + 1] <= most_steps + 1;
    if (!possible) {
      throw InputError("the place of a cooling mixture: expected one that a curve has come to");
    }
    state_.assign(place.begin(), place.end() - 2);
    step_ = place[size];
    steps_ = static_cast<int>(place[size + 1]);
  }

 private:
  using Stepper = odeint::runge_kutta_dopri5<MixtureState>;
  static constexpr double tolerance = 1e-10;
  static constexpr double longest_step = 1;  // of collisions per needle
  static constexpr double relaxed = 1e-9;    // of changes per collision
  static constexpr double equal = 1e-7;      // of temperatures in equilibrium
  // As many collisions per needle at most. Ratios that take longer to relax, as with ratios of mass
  // of thousands, are not followed to their end, which would take for ever.
  static constexpr int most_steps = 1000;
  static constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

  bool is_lost() const { return steps_ > most_steps; }
  double& time() { return state_[state_.size() - 2]; }
  double scale() const { return *std::max_element(state_.begin(), state_.end() - 2); }
  auto controlled() const {
    return odeint::make_controlled(tolerance * scale(), tolerance, Stepper());
  }

  static std::vector<Temperatures> temperatures_of(const MixtureState& state) {
    std::vector<Temperatures> out;
    for (std::size_t n = 0; n + 2 < state.size(); n += 2) {
      // Stages of a step that will be rejected can be below 0.
      out.push_back({.t_tr = std::max(0.0, state[n]), .t_rot = std::max(0.0, state[n + 1])});
    }
    return out;
  }

  // The slope over collisions per needle, or over time. Returns the collisions of a needle per
  // time.
  double differentiate(const MixtureState& state, MixtureState& slope, bool by_collisions) const {
    const std::vector<Temperatures> now = temperatures_of(state);
    const MixtureRates rates = law_.rates(now);
    const double rate =
        2 * std::accumulate(rates.collisions.begin(), rates.collisions.end(), 0.0) / count_;
    const double unit = !by_collisions ? 1 : rate > 0 ? 1 / rate : 0;
    slope.resize(state.size());
    for (std::size_t n = 0; n < now.size(); ++n) {
      slope[2 * n] = rates.temperatures[n].t_tr * unit;
      slope[2 * n + 1] = rates.temperatures[n].t_rot * unit;
    }
    slope[state.size() - 2] = unit;
    slope[state.size() - 1] = rate * unit;
    return rate;
  }

  // The relative change of all temperatures per time, if it is the same for all: their ratios have
  // relaxed, and stay.
  std::optional<double> common_loss(const MixtureState& slope, double rate) const {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    double coldest = least, hottest = 0;
    for (std::size_t n = 0; n + 2 < state_.size(); ++n) {
      if (law_.composition()[n / 2].count == 0) continue;
      if (state_[n] == 0 && slope[n] == 0) continue;
      least = std::min(least, slope[n] / state_[n]);
      most = std::max(most, slope[n] / state_[n]);
      coldest = std::min(coldest, state_[n]);
      hottest = std::max(hottest, state_[n]);
    }
    if (!(most - least <= relaxed * rate)) return std::nullopt;
    if (law_.composition().is_inelastic()) return std::max(0.0, -(most + least) / 2);
    // Where collisions keep the energy, temperatures that hardly change may still be unequal: heavy
    // needles exchange energy with light ones that slowly.
    if (!(hottest - coldest <= equal * hottest)) return std::nullopt;
    return 0;
  }

  // dT/dt = -loss T for every temperature, with a loss that falls as sqrt(T).
  void follow_haffs_law(double end, double loss, double rate) {
    const double decay = loss * (end - time()) / 2;
    for (std::size_t n = 0; n + 2 < state_.size(); ++n) {
      state_[n] /= (1 + decay) * (1 + decay);
    }
    state_.back() += rate * (end - time()) * (decay == 0 ? 1 : std::log1p(decay) / decay);
    time() = end;
  }

  // False if the end is within the step, which is then not done.
  bool step_by_collisions(double end) {
    const auto by_collisions = [&](const MixtureState& state, MixtureState& slope, double) {
      differentiate(state, slope, true);
    };
    MixtureState next = state_;
    double step = step_, at = 0;
    auto stepper = controlled();
    while (stepper.try_step(by_collisions, next, at, step) != odeint::success) {
    }
    if (next[next.size() - 2] > end) return false;
    state_ = next;
    ++steps_;
    step_ = std::min(step, longest_step);
    return true;
  }

  // The rest of the way, which is less than a step, over time.
  void finish(double end) {
    const auto by_time = [&](const MixtureState& state, MixtureState& slope, double) {
      differentiate(state, slope, false);
    };
    const double from = time();
    odeint::integrate_adaptive(controlled(), by_time, state_, from, end, end - from);
    time() = end;
  }

  MixtureLaw law_;
  double count_;
  MixtureState state_;
  double step_ = 1e-3;
  int steps_ = 0;
};

MixtureCurve::MixtureCurve(const Composition& composition, double volume,
                           std::span<const Temperatures> initial, std::vector<double> contact) {
  require(initial.size() == composition.size(), "initial", static_cast<double>(initial.size()),
          "temperatures of each species");
  for (const Temperatures& each : initial) require_valid(each);
  require(contact.empty() || contact.size() == composition.pairs(), "contact",
          static_cast<double>(contact.size()), "values of each two species");
  implementation_ =
      std::make_unique<Implementation>(composition, volume, initial, std::move(contact));
}

MixtureCurve::MixtureCurve(MixtureCurve&&) noexcept = default;
MixtureCurve& MixtureCurve::operator=(MixtureCurve&&) noexcept = default;
MixtureCurve::~MixtureCurve() = default;

std::vector<Temperatures> MixtureCurve::at(double time) {
  require_not_negative("time", time);
  implementation_->advance(time);
  return implementation_->temperatures();
}

std::vector<double> MixtureCurve::place() const { return implementation_->place(); }
void MixtureCurve::go_to(std::span<const double> place) { implementation_->go_to(place); }
double MixtureCurve::collisions_per_needle() const { return implementation_->collisions(); }

MixtureRates mixture_rates(const Composition& composition, double volume,
                           std::span<const Temperatures> now) {
  return MixtureLaw::rates_once(composition, volume, now);
}

Temperatures mean_of_species(const Composition& composition, std::span<const Temperatures> each) {
  Temperatures out{.t_tr = 0, .t_rot = 0, .turning = composition.turning_share()};
  const double count = static_cast<double>(composition.count() - composition.fixed());
  for (std::size_t n = 0; n < each.size(); ++n) {
    if (composition[n].count == 0 || composition[n].fixed) continue;
    const double share = static_cast<double>(composition[n].count) / count;
    out.t_tr += share * each[n].t_tr;
    if (composition[n].turns())
      out.t_rot += 0.5 * composition[n].rotations() * share / out.turning * each[n].t_rot;
  }
  return out;
}

std::vector<std::vector<Temperatures>> mixture_cooling(const Composition& composition,
                                                       double volume,
                                                       std::span<const Temperatures> initial,
                                                       std::span<const double> times) {
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  MixtureCurve curve(composition, volume, initial);
  std::vector<std::vector<Temperatures>> out(times.size());
  for (const std::size_t n : order) out[n] = curve.at(times[n]);
  return out;
}

}  // namespace needlework::theory
