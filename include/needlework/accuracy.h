// Settings for the reliability and the precision of first contacts.
//
// With every setting a first contact depends on the two records alone: for the same accuracy, all
// searches, calendars and numbers of threads give the same trajectory.
#pragma once

namespace needlework {

/// How intervals of time are found to be free of roots of the contact function.
enum class Isolation {
  sampling,   ///< by the signs at equal steps; misses pairs of roots between two samples
  bounds,     ///< by a Taylor expansion with bounds on its remainder
  intervals,  ///< by interval arithmetic, which includes all rounding errors
};

/// What is decided in double-double arithmetic.
enum class Escalation {
  never,      ///< no value of the contact function: double decides, whatever its errors; bounds on
              ///< derivatives may still start from coefficients in double-double
  undecided,  ///< what remains open within the error bounds of double
  always,     ///< every sign at the end of an interval that is needed, and every root
};

struct Accuracy {
  Isolation isolation = Isolation::bounds;
  Escalation escalation = Escalation::undecided;
  /// Whether the search follows pairs in float with SIMD before double does. Otherwise double
  /// follows all pairs whose bounding volumes meet.
  bool float_filter = true;
  /// A root in double is accepted when a step is below this fraction of the time since the later
  /// record; 0: when rounding limits it. At most 1e-3.
  double root_tolerance = 0;
  /// Time between two samples, in units of 1 / (|v12| + |w1| + |w2|) up to a factor of 2:
  /// from 1e-4 to 0.5.
  double sampling_step = 0x1p-5;
};

inline constexpr Accuracy fast_accuracy{.escalation = Escalation::never, .root_tolerance = 0x1p-36};
inline constexpr Accuracy standard_accuracy{};
inline constexpr Accuracy rigorous_accuracy{
    .isolation = Isolation::intervals, .escalation = Escalation::always, .float_filter = false};

}  // namespace needlework
