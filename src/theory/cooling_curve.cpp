// The cooling curve: the temperatures of a gas that stays Gaussian and homogeneous, as functions
// of time.
#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "needlework/theory.h"
#include "src/theory/cooling_law.h"
#include "src/theory/requirements.h"

namespace needlework::theory {

namespace {

namespace odeint = boost::numeric::odeint;

/// The integrated variables: the rotational share of the energy, the logarithm of the energy,
/// which falls by many decades, and the collisions per needle. The share has an equation of its
/// own that also holds at its ends, so neither T_tr = 0 nor T_rot = 0 is special.
using State = std::vector<double>;
enum Component { rotational_share, log_energy, collisions, component_count };

Temperatures split(double share) { return {.t_tr = (1.0 - share) / 1.5, .t_rot = share}; }

}  // namespace

/// The gas as a function of time, in units where the initial energy per needle is 1. At first the
/// ratio of the temperatures relaxes within a few collisions per needle, which is integrated
/// numerically. From then on the rates change only because the energy decays, and the rest of the
/// curve is Haff's law to any time: exact, and without the stiffness of the relaxed ratio.
class CoolingGas {
 public:
  CoolingGas(const Gas& gas, Temperatures initial)
      : law_(gas), final_share_(share_at(law_.stationary_q())) {
    state_[rotational_share] = initial.t_rot / initial.energy();
  }

  /// Advances to a time that is not before the present one.
  void advance(double tau) {
    while (tau_ < tau) {
      if (std::abs(state_[rotational_share] - final_share_) <= relaxed * final_share_) {
        follow_haffs_law(tau);
      } else {
        integrate_one_step(tau);
      }
    }
  }

  const State& state() const { return state_; }

  /// All that the next values depend on. (The stepper also keeps the slope at the end of its last
  /// step, which it computes again, to the same bits, when it has none.)
  CoolingCurve::Place place() const {
    return {state_[rotational_share], state_[log_energy], state_[collisions], tau_, step_};
  }
  void go_to(const CoolingCurve::Place& place) {
    std::copy_n(place.begin(), static_cast<int>(component_count), state_.begin());
    tau_ = place[component_count];
    step_ = place[component_count + 1];
  }

 private:
  /// Fehlberg 7(8) is not suitable: its error estimate does not see a slope that depends on time
  /// alone, which is nearly what remains once the ratio has relaxed.
  using Stepper = odeint::runge_kutta_dopri5<State>;
  static constexpr double absolute_tolerance = 1e-15;
  static constexpr double relative_tolerance = 1e-13;
  static constexpr double relaxed = 1e-12;

  static double share_at(double q) { return q / (1.5 + q); }

  void differentiate(const State& state, State& slope) const {
    // If a step is too long and will be rejected, its stages can lie outside [0, 1].
    const double share = std::clamp(state[rotational_share], 0.0, 1.0);
    const double root_energy = std::exp(0.5 * state[log_energy]);
    const auto [change, collision_rate] = law_.rates(split(share));
    slope[rotational_share] = root_energy * (change.t_rot - share * change.energy());
    slope[log_energy] = root_energy * change.energy();
    slope[collisions] = root_energy * collision_rate;
  }

  void integrate_one_step(double end) {
    const double remaining = end - tau_;
    const auto system = [this](const State& state, State& slope, double) {
      differentiate(state, slope);
    };
    if (step_ < remaining) {
      stepper_.try_step(system, state_, tau_, step_);
      return;
    }
    double last_step = remaining;  // shortened by the end of the interval, which is no reason to
                                   // continue with short steps
    if (stepper_.try_step(system, state_, tau_, last_step) == odeint::success) {
      tau_ = end;
    } else {
      step_ = last_step;
    }
  }

  /// dE/dtau = -loss E^(3/2), with a constant loss.
  void follow_haffs_law(double end) {
    state_[rotational_share] = final_share_;
    const auto [change, collision_rate] = law_.rates(split(final_share_));
    const double scaled_time = (end - tau_) * std::exp(0.5 * state_[log_energy]);
    const double decay = law_.is_elastic() ? 0.0 : -0.5 * change.energy() * scaled_time;
    state_[log_energy] -= 2.0 * std::log1p(decay);
    state_[collisions] +=
        collision_rate * scaled_time * (decay == 0.0 ? 1.0 : std::log1p(decay) / decay);
    tau_ = end;
  }

  CoolingLaw law_;
  double final_share_;
  State state_ = State(component_count);
  double tau_ = 0.0;
  double step_ = 1e-3;
  odeint::result_of::make_controlled<Stepper>::type stepper_ =
      odeint::make_controlled<Stepper>(absolute_tolerance, relative_tolerance);
};

namespace {

/// The temperatures in the units of `initial`. Exactly those at tau = 0.
Temperatures temperatures(const State& state, Temperatures initial, double tau) {
  if (tau == 0.0 || initial.energy() == 0.0) return initial;
  const double energy = initial.energy() * std::exp(state[log_energy]);
  const Temperatures unit = split(state[rotational_share]);
  return {.t_tr = energy * unit.t_tr, .t_rot = energy * unit.t_rot};
}

/// Calls visit(index, state) for each of `taus`, in units where the initial energy is 1.
template <class Visit>
void follow(const Gas& gas, Temperatures initial, std::span<const double> taus, Visit visit) {
  require_valid(gas);
  require_valid(initial);
  for (const double tau : taus) require_not_negative("tau", tau);
  if (initial.energy() == 0.0) return;

  std::vector<std::size_t> order(taus.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return taus[i]; });
  CoolingGas evolving(gas, initial);
  for (const std::size_t i : order) {
    evolving.advance(taus[i] * std::sqrt(initial.energy()));
    visit(i, evolving.state());
  }
}

}  // namespace

std::vector<Temperatures> cooling_curve(const Gas& gas, Temperatures initial,
                                        std::span<const double> taus) {
  std::vector<Temperatures> curve(taus.size(), initial);
  follow(gas, initial, taus, [&](std::size_t i, const State& state) {
    curve[i] = temperatures(state, initial, taus[i]);
  });
  return curve;
}

struct CoolingCurve::Implementation {
  Temperatures initial;
  std::optional<CoolingGas> evolving;  ///< empty without energy
};

CoolingCurve::CoolingCurve(const Gas& gas, Temperatures initial)
    : implementation_(std::make_unique<Implementation>(Implementation{initial, {}})) {
  require_valid(gas);
  require_valid(initial);
  if (initial.energy() > 0.0) implementation_->evolving.emplace(gas, initial);
}

CoolingCurve::CoolingCurve(CoolingCurve&&) noexcept = default;
CoolingCurve& CoolingCurve::operator=(CoolingCurve&&) noexcept = default;
CoolingCurve::~CoolingCurve() = default;

Temperatures CoolingCurve::at(double tau) {
  require_not_negative("tau", tau);
  auto& [initial, evolving] = *implementation_;
  if (!evolving) return initial;
  evolving->advance(tau * std::sqrt(initial.energy()));
  return temperatures(evolving->state(), initial, tau);
}

CoolingCurve::Place CoolingCurve::place() const {
  return implementation_->evolving ? implementation_->evolving->place() : Place{};
}

void CoolingCurve::go_to(const Place& place) {
  if (implementation_->evolving) implementation_->evolving->go_to(place);
}

std::vector<double> collisions_per_needle(const Gas& gas, Temperatures initial,
                                          std::span<const double> taus) {
  std::vector<double> counts(taus.size(), 0.0);
  follow(gas, initial, taus,
         [&](std::size_t i, const State& state) { counts[i] = state[collisions]; });
  return counts;
}

}  // namespace needlework::theory
