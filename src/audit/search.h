// Where two needles touch between their collisions: certified where numbers can tell, and where
// not, said to be doubtful.
//
// A stretch of time is settled by its middle and bounds on derivatives: f keeps its sign; or one of
// the contact points stays off its needle; or f is monotone, and its signs at both ends tell.
// Others are halved. Doubles with certain errors do nearly all of that, 113 bits the rest, so that
// what is left open lies within the pair's condition limit.
#pragma once

#include <optional>
#include <vector>

#include "src/audit/pair.h"

namespace needlework::audit {

/// A stretch of time in which the needles touch or may do so.
struct Finding {
  bool certain = false;  ///< f changes sign, with both contact points on the needles; or may do so
  double begin = 0, end = 0;
  int side = 0;  ///< sign of f before; 0 when that is open, or what has become of it
};

class Search {
 public:
  explicit Search(Pair& pair) : pair_(pair) {}

  /// The first finding in [from, to]; a pair that begins touching is looked at from 0 on.
  std::optional<Finding> first(double from, double to);
  /// The first finding in [from, to].
  std::optional<Finding> next(double from, double to);

  /// Sign of f, or 0 within twice the condition limit.
  int sign(double s);
  /// Whether both contact points lie on the needles from `begin` to `end`, if f vanishes there:
  /// 1 yes, -1 no, 0 within the condition limit.
  int on_needles(double begin, double end);

  int looked_at() const { return looked_at_; }  ///< stretches, so far

 private:
  struct Stretch {
    double begin, end;
  };
  double bend(const Sample& sample, double s, double half) const;
  bool is_free(const Sample& sample, double s, double half) const;
  bool is_noise(const Sample& sample, double s, double half) const;
  bool is_monotone(const Sample& sample, double s, double half) const;
  Sample sample_of(double s, double half);
  std::optional<Finding> leave_start(double to, double& left);
  std::optional<Finding> cross(const Stretch& stretch, int side);
  double cut(const Stretch& stretch);

  Pair& pair_;
  std::vector<Stretch> stretches_;
  int looked_at_ = 0;
};

}  // namespace needlework::audit
