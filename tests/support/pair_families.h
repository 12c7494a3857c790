// Pairs of needles for tests of the first contact: thermal ones, and the hard cases.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string_view>
#include <vector>

#include "needlework/predict.h"

namespace needlework::test {

class Random;

struct NeedlePair {
  FreeNeedle first, second;
  double horizon = 0;
  bool just_collided = false;
  std::string_view family;
  /// The contact that the pair was built around, before rounding to doubles; not always the first.
  /// For `grazing` and `just-collided` it is right to second order in the short time only.
  std::optional<double> contact_time;
};

/// Decisions closer than this to the opposite one, in units of the inputs' noise, may have either
/// result: the engine normalises directors in double, and the oracle in many digits.
inline constexpr double least_margin = 8;

/// Lengths of the first and the second needle.
using Lengths = std::array<double, 2>;

/// A family of pairs. `made_of_limits`: for most pairs rounding the inputs may reverse the
/// decision, on purpose.
struct PairFamily {
  std::string_view name;
  bool thermal;  ///< drawn from equilibrium
  bool made_of_limits;
  NeedlePair (*draw)(Random&, const Lengths&);

  /// So that a failing test names the family.
  friend void PrintTo(const PairFamily& family, std::ostream* out) { *out << family.name; }
};

/// - thermal-k6, thermal-k2: T = 1, bounding spheres meet, weighted by flux; horizon past the exit
/// - parallel: contacts at angles log-uniform in 1e-7 .. 1e-1
/// - tip: a contact 10^-x inside or outside a tip, x in 3 .. 13
/// - grazing: two roots 10^-x apart, or missing by as much, x in 2 .. 10
/// - just-collided: on a contact at t = 0, back after log-uniform 1e-6 .. 1, or with any velocity
/// - fast-spin: |w| up to 1e4 |v|;  still: one or both do not rotate
/// - slow: velocities times 2^-600 or 10^-x;  planar: w1 parallel to w2 and normal to both
/// directors
/// - mixed-scales: |w| about 1e6 |v|, and the reverse
/// - tip-to-tip: both arms 10^-x inside or outside a tip, x in 2 .. 13
/// - grazing-to-rounding: as grazing, x in 10 .. 12
/// - parallel-to-rounding: angles 1e-16 .. 1e-7;  tip-to-rounding: x in 13 .. 16
/// - back-to-rounding: as just-collided, back after 1e-12 .. 1e-6
const std::vector<PairFamily>& pair_families();

/// `count` pairs, which are the same for equal `seed` on every machine. Throws
/// std::invalid_argument for an unknown name.
std::vector<NeedlePair> draw_pairs(std::string_view family, std::size_t count, std::uint64_t seed,
                                   const Lengths& lengths = {1, 1});

/// Swaps the needles. The contact has the same time, arms swapped.
NeedlePair exchanged(const NeedlePair& pair);
/// Point reflection: r, u, v change sign, w does not. The contact has the same time and arms.
NeedlePair mirrored(const NeedlePair& pair);
/// Velocities times 2^-power, horizon times 2^power. The contact time scales alike.
NeedlePair slowed(const NeedlePair& pair, int power);
/// The motion run backwards from the horizon: free flight in many digits, rounded, then v and w
/// reversed. Its first contact is the last one of the pair.
NeedlePair reversed(const NeedlePair& pair);
/// Free flight to `time` in many digits, rounded to doubles; the horizon shrinks by as much.
NeedlePair advanced(const NeedlePair& pair, double time);

}  // namespace needlework::test
