// An independent oracle for the first contact of two needles: many digits, intervals decided by
// proven bounds, no code shared with the engine.
#pragma once

#include <cstdint>

#include "needlework/predict.h"

namespace needlework::test {

/// How the answer was found.
enum class Outcome {
  contact,
  spheres_apart,   ///< |r12| stays above the mean length, or the interval in which it does not is
                   ///< empty
  no_sign_change,  ///< f keeps its sign
  arms_outside,    ///< f changes sign, but never with both contact points on the needles
  parallel,        ///< all changes of sign come from directors that become parallel
  coplanar,        ///< f is identically 0
};

const char* name(Outcome outcome);

/// How to treat the known root at t = 0 of a pair that has just collided. In both cases the pair
/// is afterwards on the side given by the sign of f'(0).
enum class KnownRoot {
  at_zero,     ///< f(t) - f(0) is the gap: the last contact is exactly at t = 0
  as_rounded,  ///< f itself is the gap; the root at which f enters the pair's side, shifted by the
               ///< rounding of f(0), is skipped
};

/// automatic: quad, and a hundred decimals for what quad cannot decide. fewest: double first, if
/// every decision is margin_cap units of noise or more from its opposite; the time is then
/// rounded, with an error of up to 100 (1 + W t) time_limit, where W is the sum of both |w|.
enum class Digits { automatic, quad, hundred, fewest };

struct OracleOptions {
  KnownRoot known_root = KnownRoot::at_zero;
  Digits digits = Digits::automatic;
};

/// Largest margin reported; decisions with a larger one are far from their opposite.
inline constexpr double margin_cap = 64;

/// The answer, and how well the numbers given determine it.
///
/// With u = 2^-53 one unit of the *inputs' noise* changes R = r1 - r2 by u |R|, V = v1 - v2 by
/// u |V|, each director by 2u and each angular velocity by u, hence at time t
///   r12 by dr = u (|R| + 2 |V| t),  u_i by du_i = u (2 + |w_i| t),
///   f by noise_in = dr |u1 x u2| + du_1 |u2 x r12| + du_2 |u1 x r12|.
/// An evaluation of f in double adds the rounding of the products, which does not vanish with
/// |u1 x u2|: err(f) = noise_in + 2u (|R| + |V| t). After a collision |f(0)| is added to both.
struct OracleAnswer {
  bool contact = false;
  double time = 0;      ///< rounded to double; infinity without contact
  double time_low = 0;  ///< time + time_low has about twice the digits of a double
  double arm_first = 0;
  double arm_second = 0;
  Outcome outcome = Outcome::contact;

  double time_limit = 0;   ///< err(f) / (|f'| t), plus shift / t: relative
  double input_limit = 0;  ///< noise_in / (|f'| t), plus shift / t: relative
  double arm_limit = 0;    ///< of both arms, absolute, for a time wrong by err(f) / |f'|
  /// f'^2 / (2 |f''|) over err(f): how clearly doubles separate the root from a neighbouring one,
  /// a second contact or a parallel root. Near and below 1, only more digits distinguish them.
  double root_depth = 0;
  double shift = 0;  ///< for a pair that has just collided: distance between the times of both
                     ///< known_root variants

  /// Distance to the opposite decision in units of the inputs' noise, at most margin_cap. It is
  /// the least over all that could reverse the decision: a tip (| |s| - half | over the arm's own
  /// noise), two close roots or a near miss (|f| at the extremum over noise_in), an end of the
  /// interval, the side after a collision, f(0) being the start or the root. Below about 8,
  /// rounding the inputs may reverse it.
  double decision_margin = margin_cap;
  bool undecidable = false;  ///< a hundred digits cannot decide either (exact contact at a tip,
                             ///< exact touch)

  int digits = 0;                 ///< decimal digits of the arithmetic that decided
  std::uint64_t evaluations = 0;  ///< evaluations of f in double
  std::uint64_t precise = 0;      ///< evaluations of f in the wide arithmetic
};

/// First contact in (0, horizon]. Inputs are considered exact; directors are normalised and
/// angular velocities projected with all digits. Throws std::invalid_argument for input that is
/// not finite, a director 0, or an infinite horizon for a pair without relative velocity.
OracleAnswer first_contact(const FreeNeedle& first, const FreeNeedle& second, double horizon,
                           bool just_collided, const OracleOptions& options = {});

}  // namespace needlework::test
