// Pairs built around a contact: the state at the contact is chosen, and the motion is then run
// backwards.
#pragma once

#include "tests/support/pair_families.h"
#include "tests/support/random.h"

namespace needlework::test {

using Real = Quad;

struct NeedleState {
  Vec<Real> position, orientation, velocity, angular_velocity;
};

struct PairState {
  NeedleState first, second;
};

/// The needle after free flight over `time`, which may be negative.
NeedleState flown(const NeedleState& needle, const Real& time);
NeedleState read(const FreeNeedle& needle);
FreeNeedle rounded(const NeedleState& needle);

/// The parameters from which a contact state is drawn.
struct ContactRecipe {
  double angle_sine = 0;  ///< |u1 x u2| below 0.2; 0: any directors
  std::array<double, 2> arms = {0, 0};
  double speed = 1;                     ///< standard deviation of each velocity component
  std::array<double, 2> spin = {1, 1};  ///< the same for each angular velocity component
};

PairState draw_contact(Random& random, const ContactRecipe& recipe);

/// f and its derivatives at the state.
struct Slopes {
  Real f, f1, f2;
};
Slopes slopes(const PairState& pair);

/// (u1 x u2) / |u1 x u2|.
Vec<Real> contact_normal(const PairState& pair);
/// Adds `change` times the contact normal to the relative velocity, half to each needle.
void push(PairState& pair, const Real& change);

/// The pair at `time` before the state, rounded to doubles.
NeedlePair before_contact(const PairState& state, double time, double horizon);

}  // namespace needlework::test
