// Two rods of finite width and one periodic image between their collisions: whether they overlap.
//
// The distance of the axes is at least what separates them along any direction m that is not 0:
//   d |m| >= m . r12 - (L_a / 2) |m . u1| - (L_b / 2) |m . u2|.
// Here m moves with the rods: as the common normal of two sides, as the normal of one side through
// an end of the other rod, or as the line through two points. On an interval of time, middles and
// rates of change of |m|^2, the square of the distance at contact and m . u, in interval
// arithmetic, bound the right-hand side from below. Other intervals are halved. An overlap is
// proven by two points of the axes that are nearer than the rods allow. Double decides nearly all
// of it, and 113 bits the rest. Of rods that grow, points of the axes move outwards along them.
#pragma once

#include <optional>

#include "src/audit/pair_flight.h"
#include "src/audit/relative_motion.h"

namespace needlework::audit {

/// Times s are counted from the later of both records.
class RodFlight {
 public:
  /// `slack` is the uncertainty of times in addition to their resolution.
  RodFlight(const Needle& first, const Needle& second, const Shift& shift, const Space& space,
            double slack = 0);

  /// Distance of the axes at a contact at s. [L]
  double contact(double s) const { return contact_ * grown(s); }
  /// An overlap at s by more than this is reported, and twice as much is certified: half of 1e-13
  /// of the diameter, and what the numbers of the records do not hold. [L]
  double limit(double s) const;

  /// Bounds on the distance of the axes at one time, and about the rate of change of what it is
  /// beyond contact().
  struct Distance {
    double least, most, rate;
  };
  Distance at(double s);
  /// By how much the rods overlap at s, or by a rounding more, found with 113 bits; 0 where they do
  /// not. [1, of contact(s)]
  double overlap_at(double s) const;
  /// Where overlap() finds none until `to`, they have never overlapped by more. [1, of contact(0)]
  double certified(double to) const { return 2 * limit(to) / contact_; }
  /// A velocity at which rods that touch may part although they have met, by rounding.
  double noise_of_rate(double s) const;
  double rate() const { return speed(0) / size_; }  ///< of changes of the pair [1 / time]

  /// The time of an overlap by more than the limit, the first one, if there is any in [from, to]:
  /// of one by more than twice that for certain.
  std::optional<double> overlap(double from, double to);
  /// The first time in [from, to] that is found at which the rods do not overlap; else `to`.
  double end_of_overlap(double from, double to);

  bool needed_quad() const { return precise_.has_value(); }
  bool gave_up() const { return gave_up_; }     ///< overlap() has not looked at all of its interval
  int looked_at() const { return looked_at_; }  ///< number of intervals examined so far

 private:
  template <class Real>
  struct Motion {
    std::array<Flight<Ball<Real>>, 2> flights;
    std::array<Ball<Real>, 2> delay;
    Vector<Ball<Real>> r, v;  ///< r12 at s = 0, and its rate of change
    Ball<Real> growth;        ///< lengths are 1 + growth s times those at s = 0

    Ball<Real> grown(const Ball<Real>& s) const {
      return growth.middle == 0 ? Ball<Real>(1.0) : Ball<Real>(1.0) + growth * s;
    }
  };
  struct Stretch {
    double begin, end;
  };
  enum class Verdict { free, overlapping, open };
  struct Settled {
    Verdict verdict;
    bool exact;  ///< the arithmetic has digits enough
  };

  template <class Real>
  Motion<Real> motion() const;
  const Motion<Quad>& in_quad();
  template <class Real>
  Settled settle(const Motion<Real>& motion, const Stretch& stretch, double limit) const;
  double crossing(double from, double to, double limit) const;
  /// Lengths at s, those at s = 0 being 1.
  double grown(double s) const { return 1 + growth_ * s; }
  std::array<double, 2> half_lengths(double s) const {
    return {half_lengths_[0] * grown(s), half_lengths_[1] * grown(s)};
  }
  /// Bound on the rate of what the axes are beyond contact(), up to s. [L / time]
  double speed(double s) const { return (speed_ + tips_ * grown(s)) * upward; }

  const Needle& first_;
  const Needle& second_;
  Vector<double> shift_;
  Space space_;
  double slack_, scale_ = 1, growth_ = 0;  ///< lengths at s = 0 in those at the start; of them
  double contact_, size_;                  ///< at s = 0
  std::array<double, 2> half_lengths_, omega_, velocity_, delays_;
  Motion<double> motion_;
  std::optional<Motion<Quad>> precise_;
  double distance_ = 0;  ///< of the centres at s = 0
  double centres_ = 0;   ///< relative velocity of the centres
  double speed_ = 0;     ///< the same with growth
  double tips_ = 0;      ///< of both rods, by their rotation, at s = 0
  int looked_at_ = 0;
  bool gave_up_ = false;
};

}  // namespace needlework::audit
