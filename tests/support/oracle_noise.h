// How well doubles can determine a contact: the noise of f and of the arms at one time, and the
// distances to other decisions in units of the inputs' noise. Formulas: see OracleAnswer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/support/oracle.h"
#include "tests/support/oracle_motion.h"

namespace needlework::test {

/// |numerator| / |denominator|, infinity for a vanishing denominator.
inline double over(double numerator, double denominator) {
  const double ratio = std::abs(numerator) / std::abs(denominator);
  return std::isnan(ratio) ? std::numeric_limits<double>::infinity() : ratio;
}

/// The noise at one time of a pair, in double, because only sizes matter here.
struct Noise {
  double inputs = 0;                              ///< noise_in of f
  double evaluation = 0;                          ///< err(f)
  double shift_inputs = 0, shift_evaluation = 0;  ///< of the time of the root
  std::array<double, 2> arms_inputs, arms_evaluation;
  std::array<double, 2> arms;
  std::array<double, 2> half;  ///< half lengths
  /// |u_j x r12| - |x| half in units of its noise: positive means that the contact point lies off
  /// the needle. Unlike the arm it keeps its meaning where the directors become parallel.
  std::array<double, 2> moments_outside;
};

/// `residual`: |f(0)| of a pair that has just collided. f1, f2: derivatives of f at t. `reach`: the
/// arms asked for are those up to so much before or after t.
inline Noise noise_at(const Motion<double>& motion, const Geometry<double>& g, double t, double f1,
                      double f2, double residual, double reach = 0) {
  const double u = unit_roundoff<double>();
  const double distance = norm(motion.separation), speed = norm(motion.velocity);
  const double dr = u * (distance + 2 * speed * t);
  std::array<double, 2> du;
  double turned = 0;
  for (int i = 0; i < 2; ++i) {
    du[i] = u * (2 + motion.spin[i] * t);
    turned += du[i] * norm(cross(g.u[1 - i], g.separation));
  }
  const double sine = std::sqrt(g.xx);
  Noise noise;
  noise.half = motion.half;
  noise.inputs = dr * sine + turned + residual;
  noise.evaluation = noise.inputs + 2 * u * (distance + speed * t);
  // Where f' vanishes, f'' limits how far a root can move.
  const auto shift = [&](double error) {
    return std::min(over(error, f1), std::sqrt(over(2 * error, f2)));
  };
  noise.shift_inputs = shift(noise.inputs);
  noise.shift_evaluation = shift(noise.evaluation);
  for (int i = 0; i < 2; ++i) noise.arms[i] = g.numerator[i] / g.xx;
  const double direct =
      over(dr + std::abs(noise.arms[0]) * du[0] + std::abs(noise.arms[1]) * du[1], sine);
  for (int i = 0; i < 2; ++i) {
    const double rate = std::abs(g.arm_rate[i]);
    noise.arms_inputs[i] = direct + rate * (noise.shift_inputs + reach);
    noise.arms_evaluation[i] = direct + rate * noise.shift_evaluation + 4 * over(u, sine);
    const double moment = norm(cross(g.u[1 - i], g.separation));
    // Centres of long needles are far apart.
    const double lever = 2 * std::max(1.0, norm(g.separation));
    const double moment_noise = dr + lever * (du[0] + du[1]) +
                                (speed + 2 * motion.total_spin()) * (noise.shift_inputs + reach);
    noise.moments_outside[i] = (moment - motion.half[i] * sine) / moment_noise;
  }
  return noise;
}

/// Conditions that together make a contact, each with its distance from flipping.
class Conditions {
 public:
  void add(bool holds, double margin) {
    // A margin that is not a number comes from 0/0 at a degenerate state: count it as none.
    const double safe = std::isnan(margin) ? 0 : margin;
    if (holds) {
      least_held_ = std::min(least_held_, safe);
    } else {
      all_hold_ = false;
      most_broken_ = std::max(most_broken_, safe);
    }
  }

  void add_arms(const Noise& noise) {
    for (int i = 0; i < 2; ++i) {
      const double inside = noise.half[i] - std::abs(noise.arms[i]);
      // At parallel directors the arm is 0/0 and says nothing.
      const double margin = std::isnan(inside) ? 0 : over(inside, noise.arms_inputs[i]);
      add(inside > 0, inside > 0 ? margin : std::max(margin, noise.moments_outside[i]));
    }
  }

  /// If all hold, the weakest can break it; if not, all the broken ones have to be mended.
  double margin() const { return std::min(all_hold_ ? least_held_ : most_broken_, margin_cap); }

 private:
  bool all_hold_ = true;
  double least_held_ = std::numeric_limits<double>::infinity();
  double most_broken_ = 0;
};

}  // namespace needlework::test
