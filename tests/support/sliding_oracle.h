// A contact of two needles held by a force, in quad precision and by another road than the engine's
// kernel: each needle in its own coordinates, the force from the Coriolis terms alone, and an
// extrapolated midpoint rule.
#pragma once

#include "kernels/sliding_motion.h"
#include "tests/support/real.h"
#include "tests/support/vector.h"

namespace needlework::test {

struct SlidingNeedle {
  Vec<Quad> r, u, v, w;
  Quad half, mass, inertia;
};

class SlidingOracle {
 public:
  /// From the same state as the kernel, made exact: f = 0, V_n = 0, |u| = 1, w . u = 0.
  SlidingOracle(const kernels::SlidingBodies& bodies, const kernels::SlidingState& state, int side);

  /// Goes on by a time, whether or not the contact ends in it.
  void advance(const Quad& time);

  /// Time from now to the end of the contact near a guess, and how it ends.
  struct End {
    Quad time;
    kernels::SlidingEnd kind;
  };
  End end_near(double guess, kernels::SlidingEnd kind) const;
  /// Whether the contact has ended by now.
  bool has_ended() const;

  Quad energy() const;
  Vec<Quad> momentum() const;
  Quad gap() const;
  Quad speed() const;
  Quad force() const;               ///< from the Coriolis terms
  Quad force_by_curvature() const;  ///< from f'' in free flight, the other form

  /// Relative to each other, as the kernel has it.
  struct Difference {
    double position, velocity;  ///< largest of any component
  };
  Difference difference(const kernels::SlidingState& state) const;

 private:
  std::array<SlidingNeedle, 2> needles_;
  int side_;
};

}  // namespace needlework::test
