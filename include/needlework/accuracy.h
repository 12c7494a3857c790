// How much is paid for the certainty and the precision of first contacts.
//
// Whatever is chosen, a first contact depends on the two records alone: searches, calendars and
// threads give the same trajectory at equal accuracy.
#pragma once

namespace needlework {

/// How stretches of time without a root of the contact function are told.
enum class Isolation {
  sampling,   ///< by signs at equal steps: misses pairs of roots between two of them
  bounds,     ///< by a Taylor expansion with bounds on its rest
  intervals,  ///< by interval arithmetic, all rounding included
};

/// What goes to double-double arithmetic.
enum class Escalation {
  never,      ///< no value of f, which double decides without a look at its errors; bounds on its
              ///< derivatives may start from coefficients in double-double
  undecided,  ///< what the error bounds of double leave open
  always,     ///< every sign at an end of a stretch that is asked for, and every root
};

struct Accuracy {
  Isolation isolation = Isolation::bounds;
  Escalation escalation = Escalation::undecided;
  /// Searches follow pairs by lanes in float before double does. Else double follows all whose
  /// hulls or bounding spheres meet.
  bool float_filter = true;
  /// A root in double is done when a step is below this share of the time since the later
  /// record; 0: when rounding takes over.
  double root_tolerance = 0;
  /// Time between two samples, in units of 1 / (|v12| + |w1| + |w2|) up to a factor of 2.
  double sampling_step = 0x1p-5;
};

inline constexpr Accuracy fast_accuracy{.escalation = Escalation::never, .root_tolerance = 0x1p-36};
inline constexpr Accuracy standard_accuracy{};
inline constexpr Accuracy rigorous_accuracy{
    .isolation = Isolation::intervals, .escalation = Escalation::always, .float_filter = false};

}  // namespace needlework
