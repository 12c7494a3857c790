#include "src/effects/driving/andersen.h"

#include <cmath>

#include "src/physics/director.h"
#include "src/physics/vectors.h"
#include "src/random/needle_random.h"

namespace needlework {

Andersen::Andersen(Gas& gas, const Parameters& parameters)
    : parameters_(parameters),
      redraws_(gas.columns.add<std::uint64_t>("redraws", 0)),
      next_(gas.columns.add<Time>("next redraw", Time::never())) {}

// The numbers of redraw n give its velocities, then the time to the next; those of no redraw give
// the time of the first.
void Andersen::begin(const Gas& gas) {
  for (Needle i{0}; i < gas.size(); ++i) {
    if (gas.is_fixed(i)) continue;
    NeedleRandom random(parameters_.seed, gas.ids[i].value, RandomFor::thermostat, 0);
    next_[i] = gas.clock.add({}, random.exponential() / parameters_.rate);
  }
}

SourceEvent Andersen::next(const Gas&, Needle i, Time, Time until) const {
  return next_[i] > until ? SourceEvent{} : SourceEvent{.time = next_[i]};
}

SourceOutcome Andersen::happen(const Gas& gas, const NeedleAt& at, std::int8_t) {
  NeedleRandom random(parameters_.seed, at.id.value, RandomFor::thermostat, ++redraws_[at.needle]);
  const double mass = at.body.mass, inertia = at.body.inertia;
  SourceOutcome out;
  out.changes_motion = true;
  out.velocity = vector_of(random.normal()) * std::sqrt(parameters_.temperature / mass);
  // Smooth spheres draw the same numbers, and do not turn.
  const double spread = at.body.turns() ? std::sqrt(parameters_.temperature / inertia) : 0;
  out.angular_velocity = turned(at.body, vector_of(random.normal()) * spread, at.director);
  next_[at.needle] = gas.clock.add(at.now, random.exponential() / parameters_.rate);
  const Vec3d &v = out.velocity, &w = out.angular_velocity;
  out.energy_change = 0.5 * (mass * (dot(v, v) - dot(at.velocity, at.velocity)) +
                             inertia * (dot(w, w) - dot(at.angular_velocity, at.angular_velocity)));
  out.impulse = (v - at.velocity) * mass;
  return out;
}

std::vector<double> Andersen::parameters() const {
  const auto [low, high] = halves(parameters_.seed);
  return {parameters_.rate, parameters_.temperature, low, high};
}

}  // namespace needlework
