// First contact of two needles: the definition of every collision in Needlework.
//
// Time since the later record is cut into intervals [n h, (n + 1) h], h = 2^-1 / rate, and each is
// halved until a test of that interval alone settles it:
//   free      f keeps its sign on it (Taylor expansion at the middle with a bound on the rest),
//   monotone  f' keeps its sign: at most one root, known from the signs at the ends,
//   folded    f'' keeps its sign: at most two roots, known from the ends and the extremum between.
// A root counts when f changes sign there and both arms are inside the needles. Every decision is
// taken in double where its error bounds allow and in double-double otherwise. The result depends
// on the pair alone: not on when or from which interval the search starts, nor where it ends.
#pragma once

#include <cstdint>

#include "kernels/contact_function.h"
#include "needlework/accuracy.h"

namespace needlework::kernels {

/// Evaluations of the contact function; each call adds to them.
struct EvaluationCounters {
  std::uint64_t evaluated = 0;  ///< evaluations of f in double
  std::uint64_t escalated = 0;  ///< evaluations of f in double-double
  /// Work after which first_contact() halves no more intervals; what it returns then is worth
  /// nothing.
  std::uint64_t most_work = ~std::uint64_t{0};

  /// In evaluations in double; those in double-double take some eight times as long.
  std::uint64_t work() const { return evaluated + 8 * escalated; }
  bool is_spent() const { return work() > most_work; }
};

struct Contact {
  bool found = false;
  /// The needles touch to within rounding at s = 0, and Pair::touch does not say on which side:
  /// nothing was decided. The caller settles it from the records before s = 0.
  bool side_unknown = false;
  /// The pair has just collided and returns at once, below what velocities in double resolve.
  bool unresolvable = false;
  /// Bodies that exclude a volume: they are nearer at s = 0 than rounding explains, see
  /// rod_contact().
  bool overlap = false;
  DoubleDouble
      elapsed;   ///< time since s = 0 [time]; the low part only where double-double refined it
  int side = 0;  ///< sign of f before the contact
};

/// The first contact with elapsed time in (0, until]. The caller promises that there is none before
/// `from`, so that intervals wholly before it are skipped. `until` must be finite.
Contact first_contact(const Pair& pair, double from, double until, EvaluationCounters& counters,
                      const Accuracy& accuracy = standard_accuracy);

/// The pair at the moment of contact.
struct ContactGeometry {
  Vec3d u_first, u_second;
  Vec3d normal;           ///< (u1 x u2) / |u1 x u2|
  double sin_angle = 0;   ///< |u1 x u2|
  double arm_first = 0;   ///< s12, within the half length of the first needle [L]
  double arm_second = 0;  ///< s21, within that of the second [L]
};
ContactGeometry contact_geometry(const Pair& pair, const DoubleDouble& elapsed);

/// Two needles that have collided at s = 0, the time of both records, surely do not meet again
/// before this [time]; it is 0 if they hardly part, or too slowly to tell.
double time_apart(const Pair& pair);

/// Sign of f just after s = 0 for a pair that touches there, f(0) = 0, taken from f' or f''.
int side_after(const Pair& pair);

/// The contact function at one time, continued from a touch, evaluated in double-double. [L]
double gap_at(const Pair& pair, const DoubleDouble& elapsed);

}  // namespace needlework::kernels
