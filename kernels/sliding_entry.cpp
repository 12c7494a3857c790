#include "kernels/sliding_entry.h"

#include <algorithm>
#include <cmath>

namespace needlework::kernels {
namespace {

// Acceleration of the contact points towards each other.
double pressing(const SlidingBodies& bodies, const SlidingState& state, int side) {
  const SlidingContact contact = sliding_contact(bodies, state);
  return side * contact.force * contact.inverse;
}

bool lasts(const SlidingBodies& bodies, SlidingState state, int side, double remaining) {
  while (remaining > 0) {
    const SlidingStep step = sliding_step(bodies, state, side, remaining);
    if (step.end != SlidingEnd::None) return step.duration >= remaining;
    remaining -= step.duration;
    state = state_after(bodies, step);
  }
  return true;
}

}  // namespace

SlidingEntry sliding_entry(const SlidingBodies& bodies, const SlidingState& before, double epsilon,
                           double below, bool crowded) {
  const SlidingContact contact = sliding_contact(bodies, before);
  SlidingEntry out;
  out.epsilon = epsilon;
  out.side = contact.speed > 0 ? -1 : 1;
  const auto reject = [&](SlidingDecision why) {
    out.decision = why;
    return out;
  };
  if (epsilon == 1) return reject(SlidingDecision::Elastic);
  const double stop = -contact.speed / contact.inverse;
  const SlidingState bounced = after_impulse(bodies, before, contact, (1 + epsilon) * stop);
  if (crowded) {
    // What presses the needles may come by the third one, and is not known here.
    const auto size = [](const Vec3d& a) { return std::sqrt(dot(a, a)); };
    const double speeds = size(before.v) + (size(before.w_first) + size(before.w_second)) *
                                               (bodies.first.half + bodies.second.half);
    const double needed = contact.rate * speeds * below / (2 * std::abs(contact.speed));
    if (needed > epsilon) out.epsilon = std::min(1.0, needed);
    return reject(SlidingDecision::Crowded);
  }
  const double flight_pressed = pressing(bodies, bounced, out.side);
  if (!(flight_pressed > 0)) return reject(SlidingDecision::Parts);
  const double flight = 2 * epsilon * std::abs(contact.speed) / flight_pressed;
  if (epsilon > 0 && !(flight < below)) return reject(SlidingDecision::LongFlight);
  out.after = in_contact(bodies, after_impulse(bodies, before, contact, stop));
  if (!(pressing(bodies, out.after, out.side) > 0)) return reject(SlidingDecision::Parts);
  out.train = flight / (1 - epsilon);
  if (!lasts(bodies, out.after, out.side, 2 * out.train))
    return reject(SlidingDecision::ShortContact);
  out.decision = SlidingDecision::Enters;
  out.loss = contact.speed * contact.speed / (2 * contact.inverse);
  return out;
}

}  // namespace needlework::kernels
