// Finds where two needles touch between their collisions. The result is certified if the numbers
// determine it, and otherwise reported as doubtful.
//
// An interval of time is decided by a sample in its middle and bounds on derivatives: f keeps its
// sign, or one contact point stays off its needle, or f is monotone and its signs at both ends
// decide. Other intervals are halved. Double with certified errors decides nearly all of them, and
// 113 bits the rest, so that what remains open is within the pair's condition limit.
#pragma once

#include <optional>
#include <vector>

#include "src/audit/pair_flight.h"

namespace needlework::audit {

/// An interval of time in which the needles touch or may touch.
struct ContactInterval {
  bool certain = false;  ///< true: f changes sign with both contact points on the needles; false:
                         ///< it may
  double begin = 0, end = 0;
  int side = 0;  ///< sign of f before; 0 if it is open
};

class ContactFinder {
 public:
  explicit ContactFinder(PairMotion& pair) : pair_(pair) {}

  /// The first contact, certain or possible, in [from, to]. A pair that starts touching is examined
  /// from 0 on.
  std::optional<ContactInterval> first(double from, double to);
  /// The same for a pair that does not start touching.
  std::optional<ContactInterval> next(double from, double to);

  /// Sign of f, or 0 within twice the condition limit.
  int sign(double s);
  /// Whether both contact points are on the needles from `begin` to `end` if f vanishes there: 1
  /// yes, -1 no, 0 within the condition limit.
  int on_needles(double begin, double end);

  int looked_at() const { return looked_at_; }  ///< Number of intervals examined so far.

 private:
  struct Stretch {
    double begin, end;
  };
  double bend(const Sample& sample, double s, double half) const;
  bool is_free(const Sample& sample, double s, double half) const;
  bool is_noise(const Sample& sample, double s, double half) const;
  bool is_monotone(const Sample& sample, double s, double half) const;
  Sample sample_of(double s, double half);
  std::optional<ContactInterval> leave_start(double to, double& left);
  std::optional<ContactInterval> cross(const Stretch& stretch, int side);
  double cut(const Stretch& stretch);

  PairMotion& pair_;
  std::vector<Stretch> stretches_;
  int looked_at_ = 0;
};

}  // namespace needlework::audit
