// The motion of two needles in contact, one step after another, until the contact ends.
//
// A step is a collocation by Gauss with ten stages. Its polynomial is the motion: anything that
// looks at a needle during the step evaluates that. A step is a pure function of the state that it
// begins with, the side and the limit; the next one begins with state_after() of it, so one step is
// all that has to be kept. A contact ends where the force passes 0, or where an arm has reached the
// end of its needle; no impulse acts there.
#pragma once

#include <array>

#include "kernels/sliding_pair.h"

namespace needlework::kernels {

enum class SlidingEnd : unsigned char {
  None,   ///< the contact goes on
  Force,  ///< the force would have to pull: the needles part, on the side where they were
  Tip,    ///< an arm has reached a tip: the needles pass each other, legally, to the other side
  Unresolvable,  ///< no step is short enough for the needles' arithmetic: they are all but parallel
};

/// A step of the motion in contact.
struct SlidingStep {
  static constexpr int stages = 10, components = 18;

  SlidingState begin;
  double span = 0;                    ///< what the polynomials span [time]
  double duration = 0;                ///< until the step or the contact ends, at most `span` [time]
  SlidingEnd end = SlidingEnd::None;  ///< what happens after `duration`
  int evaluations = 0;                ///< of the force
  /// Of the derivatives of the state's components, in Legendre's polynomials on the span.
  std::array<std::array<double, stages>, components> slopes{};

  /// The motion, for elapsed times in [0, duration]. [time]
  SlidingState at(double elapsed) const;
  /// What is not exceeded on the span.
  struct Most {
    double speed = 0, acceleration = 0;                        ///< of r [L / time, L / time^2]
    double turning_first = 0, turning_second = 0;              ///< |w| [1 / time]
    double turned_faster_first = 0, turned_faster_second = 0;  ///< |w'| [1 / time^2]
  };
  Most most() const;
};

/// The step from a state in contact, f = 0 and V_n = 0 up to rounding, with `side` the sign of f
/// before the contact. It spans at most `limit` [time], which must be above 0 and may be infinite
/// unless both needles are at rest relative to each other.
SlidingStep sliding_step(const SlidingBodies& bodies, const SlidingState& begin, int side,
                         double limit);

/// The state at the end of a step, with f = 0, V_n = 0, |u| = 1 and w . u = 0 restored to rounding.
SlidingState state_after(const SlidingBodies& bodies, const SlidingStep& step);

/// The same for any state that is nearly in contact.
SlidingState in_contact(const SlidingBodies& bodies, const SlidingState& state);

/// Sign of f after the contact has ended in free flight.
inline int side_after(SlidingEnd end, int side) { return end == SlidingEnd::Tip ? -side : side; }

}  // namespace needlework::kernels
