// An independent oracle for the first contact of two needles: many digits, interval isolation by
// proven bounds, no code shared with the engine.
#pragma once

#include <cstdint>

#include "needlework/predict.h"

namespace needlework::test {

/// How the answer came about.
enum class Outcome {
  contact,
  spheres_apart,   ///< |r12| stays above 1, or the window in which it does not is empty
  no_sign_change,  ///< f keeps its sign
  arms_outside,    ///< f changes sign, but at no such time both contact points lie on the needles
  parallel,        ///< all changes of sign come from directors that become parallel
  coplanar,        ///< f is identically 0
};

const char* name(Outcome outcome);

/// What to do with the known root at t = 0 of a pair that has just collided. The side on which the
/// pair stands after it is the sign of f'(0) in both cases.
enum class KnownRoot {
  at_zero,     ///< f(t) - f(0) is the gap: the contact just had is exactly at t = 0
  as_rounded,  ///< f itself; the root into the pair's side, moved by the rounding of f(0), is
               ///< skipped
};

/// automatic: quad, and a hundred decimals for what quad leaves open. fewest: double first, where
/// every decision lies margin_cap units of noise or more from its opposite; then the time is
/// a rounded one, wrong by up to 100 (1 + W t) time_limit, W the sum of both |w|.
enum class Digits { automatic, quad, hundred, fewest };

struct OracleOptions {
  KnownRoot known_root = KnownRoot::at_zero;
  Digits digits = Digits::automatic;
};

/// Margins are cut off here: beyond, nothing is near.
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
  /// f'^2 / (2 |f''|) over err(f): how clearly doubles separate the root from a neighbouring one, a
  /// second contact or a parallel root. Near and below 1, only more digits tell them apart.
  double root_depth = 0;
  double shift = 0;  ///< just collided: distance between the times of both known_root variants

  /// Distance to the other decision in units of the inputs' noise, at most margin_cap. The least
  /// over all that could flip it: a tip (| |s| - 1/2 | over the arm's own noise), two close roots
  /// or a near miss (|f| at the extremum over noise_in), an end of the interval, the side after a
  /// collision, f(0) being the start or the root. Below about 8, rounding the inputs may flip it.
  double decision_margin = margin_cap;
  bool undecidable = false;  ///< not even a hundred digits tell (exact tip hit, exact touch)

  int digits = 0;                 ///< decimal digits of the arithmetic that decided
  std::uint64_t evaluations = 0;  ///< of f in double
  std::uint64_t precise = 0;      ///< of f in the wide arithmetic
};

/// First contact in (0, horizon]. Inputs are taken as exact; directors are normalised and angular
/// velocities projected with all digits. Throws std::invalid_argument for input that is not finite,
/// a director 0, or an infinite horizon for a pair without relative velocity.
OracleAnswer first_contact(const FreeNeedle& first, const FreeNeedle& second, double horizon,
                           bool just_collided, const OracleOptions& options = {});

}  // namespace needlework::test
