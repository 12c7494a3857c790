// Bodies that grow: all lengths of all bodies in proportion, linearly in time.
#pragma once

#include "src/physics/clock.h"

namespace needlework {

/// The sizes of the bodies of a gas as a share of those that it knows, which are the largest that
/// they reach: searches work with these, and only contacts, walls and reports ask for the present
/// ones. Masses and moments of inertia do not change.
class Growth {
 public:
  /// `scale` is the share at the start, below 1, `rate` what it grows by. [1 / time]
  Growth(double scale, double rate) : scale_(scale), rate_(rate) {}

  double scale_at(const Clock& clock, Time now) const {
    return scale_ + rate_ * clock.difference(now, since_);
  }
  /// Of the scale, by which share of itself it grows. [1 / time]
  double relative_rate(double scale) const { return rate_ / scale; }
  double rate() const { return rate_; }
  /// When the scale is 1; by the start and the rate, whatever count_from() rounds.
  Time end() const { return end_; }
  /// To be called at the start.
  void find_end(const Clock& clock) { end_ = clock.add({}, (1 - scale_) / rate_); }
  /// Counts time from `now` on, so that the scale keeps its precision.
  void count_from(const Clock& clock, Time now) {
    scale_ = scale_at(clock, now);
    since_ = now;
  }

  template <class A>
  void transfer(A& archive) {
    archive(scale_, rate_, since_, end_);
  }

 private:
  double scale_, rate_;
  Time since_, end_ = Time::never();
};

}  // namespace needlework
