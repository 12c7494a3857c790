// Two needles and one periodic image between their collisions: the contact function with certain
// error bounds, and what the numbers given leave open of it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "src/audit/flight.h"

namespace needlework::audit {

/// Boxes added to the second needle's centre.
using Shift = std::array<std::int32_t, 3>;

/// A needle's record, and its flight ready for use in double.
struct Needle {
  explicit Needle(const Record& given) : record(given), flight(given) {}
  Record record;
  Flight<Ball<double>> flight;
};

/// How a pair begins: apart, or touching with a side known from the flights before.
struct Start {
  enum Kind {
    apart,
    collided,  ///< with each other: f begins at 0, on `side`, or 0 where that is open
    touching,  ///< f(0) cannot be told from 0, but the pair is on `side` of a contact
  };
  Kind kind = apart;
  int side = 0;
  /// f(0) of a pair that goes on near a contact without having collided: f at the end of the flight
  /// before.
  std::optional<double> gap;
  double gap_error = 0;  ///< by which that is open
};

/// The gas that pairs live in.
struct Space {
  std::array<double, 3> box{};

  /// What rounding a new record can change of a contact function. [L]
  double rounding() const { return 0x1p-51 * (1 + box[0] + box[1] + box[2]); }
  /// Below this f goes on from one flight to the next, where contact points are on the needles or
  /// within `beside` of them: the engine's rule, so that trains of bounces are told to the end. [L]
  double continued() const { return 0x1p-44 * (1 + box[0] + box[1] + box[2]); }
};

/// Beyond so many lengths or radians of flight the engine may have rounded a record on the way.
inline constexpr double longest_record = 0x1p9;

/// So far beyond a tip a contact point still counts as near the needle. [L]
inline constexpr double beside = 0x1p-18;

/// Times are multiples of this, or finer. [epochs]
inline constexpr double resolution = 0x1p-52;

/// What is known at one time. Doubles hold the value; errors are of the arithmetic alone.
struct Sample {
  double f, f_error;    ///< f = r12 . (u1 x u2)
  double df, df_error;  ///< its time derivative
  double distance;      ///< |r12|, not below
  double sine;          ///< |u1 x u2|, not below
  /// |u2 x r12| and |u1 x r12|; at a contact |s12| and |s21| times the sine.
  std::array<double, 2> moment_least, moment_most;
  /// (sine^2 / 2 - |(u2 x r12).(u1 x u2)|), and so for u1: positive when the contact points lie on
  /// the needles.
  std::array<double, 2> margin, margin_error;
};

/// Times s are counted from the later of both records.
class Pair {
 public:
  Pair(const Needle& first, const Needle& second, const Shift& shift, const Space& space,
       const Start& start);

  /// In double; what that cannot tell, `precise` can.
  Sample sample(double s) const;
  Sample precise(double s);
  bool needed_quad() const { return precise_.has_value(); }

  double speed() const { return speed_; }  ///< |v12|, not below
  double spin() const { return spin_; }    ///< |w1| + |w2|, not below
  double rate() const { return speed_ + spin_; }
  /// Bound on |f''| from `begin` to `end`, where |r12| is at most `distance`. [L / time^2]
  double bend(double begin, double end, double distance) const;
  /// Sharpens that bound for needles in nearly one plane; takes 113 bits.
  void find_coefficients();
  /// Bound on how fast `moment` i and |r12| at most `distance` can change. [L / time]
  double moment_rate(int i, double distance) const { return speed_ + omega_[1 - i] * distance; }

  /// The condition limit: by how much f is uncertain within `half` of the time of the sample, when
  /// each number of the records, positions relative to each other, may be off by half a unit, and
  /// f is computed in double. [L]
  double limit(const Sample& sample, double s, double half = 0) const;
  /// The same of `margin`.
  double margin_limit(const Sample& sample, double s) const;
  /// Whether f goes on from its value at s into a flight that begins there.
  bool is_near_contact(double s) const;
  const Start& start() const { return start_; }

 private:
  struct Uncertainty {
    double distance;                  ///< of r12
    std::array<double, 2> directors;  ///< of u1 and u2
    double lengths;                   ///< that f is computed from [L]
  };
  Uncertainty uncertainty(double s) const;

  struct Precise {
    Flight<Ball<Quad>> first, second;
    std::array<Ball<Quad>, 2> delay;
  };
  const Precise& in_quad();

  const Needle& first_;
  const Needle& second_;
  Vector<double> shift_;
  Space space_;
  Start start_;
  std::array<Ball<double>, 2> delay_;  ///< from the records to s = 0
  std::array<double, 2> omega_, velocity_;
  double speed_ = 0, spin_ = 0;
  double distance_ = 0;  ///< |r12| at s = 0, not below
  double offset_ = 0;    ///< by which f(0) is off what the flight before says
  double slope_ = 0;     ///< f'(0) of a pair that has just collided and by rounding approaches
  std::optional<Precise> precise_;
  // Of f, as a sum over products of one of {cosine, sine} of each needle's angle since its record.
  struct Coefficient {
    double constant, linear;  ///< in time; not below their sizes
  };
  using Coefficients = std::array<std::array<Coefficient, 2>, 2>;
  std::optional<Coefficients> coefficients_;
};

}  // namespace needlework::audit
