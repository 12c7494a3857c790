// States in which two needles bounce on each other faster and faster.
#pragma once

#include "needlework/scene.h"
#include "needlework/state.h"
#include "tests/support/contact_state.h"

namespace needlework::test {

/// Needle 0 is along x, above needle 1 along y. Needle 1 turns its contact point towards needle 0,
/// which slides along it, so that the gap's acceleration is always -2 w v_y < 0.
inline State collapsing_pair(double approach) {
  State state;
  state.box = {6, 6, 6};
  state.position = {{3, 2.6, 3.001}, {3, 3, 3}};
  state.orientation = {{1, 0, 0}, {0, 1, 0}};
  state.velocity = {{0, 0.5, -0.4 - approach}, {0, -0.5, 0}};
  state.angular_velocity = {{0, 0, 0}, {1, 0, 0}};
  return state;
}

/// Two random needles shortly before a contact to which their rotation drives them back. Times
/// between bounces start at some hundredths of a time unit and shrink.
inline State draw_collapsing_pair(Random& random) {
  for (;;) {
    const double arm = random.uniform(-0.35, 0.35), other = random.uniform(-0.35, 0.35);
    PairState pair = draw_contact(random, {.arms = {arm, other}, .speed = 0.7, .spin = {2, 2}});
    const Real sine = norm(cross(pair.first.orientation, pair.second.orientation));
    if (sine < 0.3) continue;
    push(pair, -slopes(pair).f1 / sine);
    const Real acceleration = slopes(pair).f2 / sine;
    if (abs(acceleration) < 0.5) continue;
    // f approaches from the side towards which f'' drives.
    push(pair, acceleration * Real(random.uniform(0.005, 0.02)));
    const NeedlePair before = before_contact(pair, 0.01, 1);
    State state;
    state.box = {6, 6, 6};
    for (const FreeNeedle* needle : {&before.first, &before.second}) {
      const auto& r = needle->position;
      state.position.push_back({r[0] + 3, r[1] + 3, r[2] + 3});
      state.orientation.push_back(needle->orientation);
      state.velocity.push_back(needle->velocity);
      state.angular_velocity.push_back(needle->angular_velocity);
    }
    return state;
  }
}

}  // namespace needlework::test
