// Two needles and one periodic image between their collisions: the contact function with certified
// error bounds, and how uncertain it is because of the rounded input.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "src/audit/flight.h"
#include "src/audit/growth.h"
#include "src/audit/rows.h"

namespace needlework::audit {

/// Number of boxes added to the second needle's centre.
using Shift = std::array<std::int32_t, 3>;

/// What a needle is made of, at the start. Lengths of an audit are in a unit that no needle is
/// longer than then.
struct AuditedBody {
  std::size_t species = 0;  ///< index
  double length = 1, mass = 1, k = 6;
  double diameter = 0;  ///< 0 of thin needles
  double q = 0;         ///< 4 I / (m D^2) of rough spheres

  bool has_axis() const { return length > 0; }
  /// Over so many components of the spin a rotational temperature is.
  int rotations() const { return has_axis() ? 2 : 3; }
  /// Its mass in sums over all that move: 0 of fixed ones, whose mass is infinite.
  double moving_mass() const { return std::isinf(mass) ? 0 : mass; }
  double extent() const { return length + diameter; }  ///< from end to end [L]
  /// With lengths as many times as large, and the same mass and moment of inertia.
  AuditedBody grown(double scale) const {
    AuditedBody out = *this;
    out.length *= scale;
    out.diameter *= scale;
    out.k *= scale * scale;
    out.q /= scale * scale;
    return out;
  }
  template <class Real>
  Real inverse_mass() const {
    return std::isinf(mass) ? Real(0) : 1 / Real(mass);
  }
  /// I / m = L^2 / (2 k), or q D^2 / 4 of spheres, whose length is 0; 0 of smooth ones.
  template <class Real>
  Real inertia_per_mass() const {
    return has_axis() ? Real(length) * length / (2 * Real(k)) : Real(q) * diameter * diameter / 4;
  }
  template <class Real>
  Real inverse_inertia() const {
    const Real per_mass = inertia_per_mass<Real>();
    return per_mass == 0 || std::isinf(mass) ? Real(0) : 1 / (Real(mass) * per_mass);
  }
};

/// A needle's record, and its flight prepared for double.
struct Needle {
  explicit Needle(const Record& given, const AuditedBody& made_of = {})
      : record(given), flight(given, made_of.has_axis()), body(made_of) {}
  template <class T>
  Flight<T> flight_as() const {
    return Flight<T>(record, body.has_axis());
  }
  /// Its angular velocity in this pose. All of a sphere's is that of its record.
  template <class T>
  Vector<T> spin(const Pose<T>& pose) const {
    return body.has_axis() ? cross(pose.u, pose.du) : to<T>(record.w);
  }
  Record record;
  Flight<Ball<double>> flight;
  AuditedBody body;
  /// By so many lengths and radians of flight the record is as uncertain, if the audit has computed
  /// it itself.
  double worn = 0;
};

/// The start of a pair's flight: apart, or touching with a side known from previous flights.
struct Start {
  enum Kind {
    apart,
    collided,     ///< with each other: f starts at 0, on `side`, or with unknown side if that is 0
    touching,     ///< f(0) cannot be distinguished from 0, but the pair is on `side` of a contact
    overlapping,  ///< rods of which a missed or late contact has been reported
  };
  Kind kind = apart;
  int side = 0;
  /// f(0) of a pair that stays near a contact without a collision, which is f at the end of the
  /// previous flight.
  std::optional<double> gap;
  double gap_error = 0;  ///< uncertainty of `gap`
};

/// The gas that the pairs belong to.
struct Space {
  std::array<double, 3> box{};
  double longest = 1;  ///< length of the longest needle, at any time
  std::array<bool, 3> periodic{true, true, true};
  Vector<double> gravity{};           ///< acceleration of all needles [L / time^2]
  double outside = 0;                 ///< by so much coordinates may be beyond the box [L]
  std::optional<Rows> rows = {};      ///< of images, where they slide
  std::optional<Growth> growth = {};  ///< of all bodies

  /// Present lengths, those at the start being 1.
  double scale_at(const Instant& now) const {
    return growth ? static_cast<double>(growth->scale_at(now)) : 1;
  }
  /// The number of boxes nearest to a distance along an axis; 0 where there are no images.
  template <class Real>
  Real boxes_along(int axis, const Real& distance) const {
    using std::floor;
    if (!periodic[static_cast<std::size_t>(axis)]) return Real(0);
    return floor(distance / Real(box[static_cast<std::size_t>(axis)]) + Real(0.5));
  }
  /// Whether records, or images, are rounded between the events that are told.
  bool rounds() const { return norm(gravity) > 0 || rows; }
  /// Largest change of a contact function by rounding a new record. [L]
  double rounding() const { return 0x1p-51 * (1 + box[0] + box[1] + box[2] + outside); }
  /// If |f| is below this and contact points are on the needles or within `beside` of them, f is
  /// continued from one flight to the next. This is the engine's rule, so that sequences of
  /// bounces are followed to their end. [L]
  double continued() const { return 0x1p-44 * (longest + box[0] + box[1] + box[2] + outside); }
  /// The same for what happens at this place, which may be far from the box where a side is open.
  Space around(const Vector<double>& place) const {
    Space out = *this;
    double beyond = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto each = static_cast<std::size_t>(axis);
      if (!periodic[each]) beyond += std::max(0.0, std::abs(place[axis]) - box[each]);
    }
    out.outside = std::max(outside, beyond);
    return out;
  }
};

/// After this many of a needle's lengths, or radians, of flight the engine may have renewed and
/// rounded its record.
inline constexpr double longest_record = 0x1p9;

/// Largest distance of a contact point beyond a tip at which it counts as near the needle, in mean
/// lengths of the two needles.
inline constexpr double beside = 0x1p-18;

/// Times are multiples of this or finer. [epochs]
inline constexpr double resolution = 0x1p-52;

/// The values at one time. Errors are those of the arithmetic alone.
struct Sample {
  double f, f_error;    ///< f = r12 . (u1 x u2)
  double df, df_error;  ///< its time derivative
  double distance;      ///< lower bound on |r12|
  double sine;          ///< lower bound on |u1 x u2|
  /// Bounds on |u2 x r12| and |u1 x r12|; at a contact these are |s12| and |s21| times the sine.
  std::array<double, 2> moment_least, moment_most;
  /// sine^2 L / 2 - |(u2 x r12).(u1 x u2)|, L the length of the first needle, and the same for the
  /// second one and u1; positive if the contact points are on the needles.
  std::array<double, 2> margin, margin_error;
};

/// Two needles and one periodic image, as the contact finder looks at them. Times s are counted
/// from the later of both records.
class PairMotion {
 public:
  virtual ~PairMotion() = default;

  /// Values in double; use `precise` if their errors are too large.
  virtual Sample sample(double s) const = 0;
  virtual Sample precise(double s) = 0;
  virtual bool needed_quad() const = 0;

  double speed() const { return speed_; }  ///< upper bound on |v12|.
  double spin() const { return spin_; }    ///< upper bound on |w1| + |w2|.
  /// Of changes of the pair. [1 / time]
  double rate() const { return speed_ / size() + spin_ + hurry_; }
  double half_length(int i) const { return half_lengths_[i]; }         ///< of either needle [L]
  double size() const { return half_lengths_[0] + half_lengths_[1]; }  ///< mean length [L]
  /// Bound on |f''| from `begin` to `end`, where |r12| is at most `distance`. [L / time^2]
  virtual double bend(double begin, double end, double distance) const = 0;
  /// The same of the `margin`s of a sample.
  double margin_bend(double distance) const {
    return spin_ * (2 * spin_ + 4 * speed_ + 4 * distance * spin_) +
           (turned_faster_ * (1 + 2 * distance) + acceleration_);
  }
  /// Improves the bound on |f''| for needles that are nearly in one plane; uses 113 bits.
  virtual void find_coefficients() {}
  /// Bound on the rates of change of `moment` i and of |r12|, where |r12| is at most `distance`.
  /// [L / time]
  double moment_rate(int i, double distance) const { return speed_ + omega_[1 - i] * distance; }

  /// The condition limit: the uncertainty of f within `half` of the time of the sample, if each
  /// number of the records, with relative positions, may be off by half a unit, and f is computed
  /// in double. [L]
  virtual double limit(const Sample& sample, double s, double half = 0) const = 0;
  /// The same for `margin`.
  virtual double margin_limit(const Sample& sample, double s) const = 0;
  /// Whether the value of f at s is continued into a flight that starts there.
  bool is_near_contact(double s) const;
  const Start& start() const { return start_; }

 protected:
  PairMotion(const AuditedBody& first, const AuditedBody& second, const Space& space,
             const Start& start)
      : space_(space), start_(start), half_lengths_{first.length / 2, second.length / 2} {}

  Space space_;
  Start start_;
  std::array<double, 2> half_lengths_;
  std::array<double, 2> omega_{};  ///< bounds on both |w|
  double speed_ = 0, spin_ = 0;
  /// Bounds on |v12'| and |w1'| + |w2'|, which are 0 in free flight, and what they add to the rate.
  double acceleration_ = 0, turned_faster_ = 0, hurry_ = 0;
};

/// Both needles fly freely.
class PairFlight final : public PairMotion {
 public:
  PairFlight(const Needle& first, const Needle& second, const Shift& shift, const Space& space,
             const Start& start);

  Sample sample(double s) const override;
  Sample precise(double s) override;
  bool needed_quad() const override { return precise_.has_value(); }
  double bend(double begin, double end, double distance) const override;
  void find_coefficients() override;
  double limit(const Sample& sample, double s, double half = 0) const override;
  double margin_limit(const Sample& sample, double s) const override;

 private:
  struct Uncertainty {
    double distance;                  ///< of r12
    std::array<double, 2> directors;  ///< of u1 and u2
    double lengths;                   ///< lengths from which f is computed [L]
  };
  Uncertainty uncertainty(double s) const;

  struct Precise {
    Flight<Ball<Quad>> first, second;
    std::array<Ball<Quad>, 2> delay;
  };
  const Precise& in_quad();

  const Needle& first_;
  const Needle& second_;
  /// Of both, as if they flew freely: gravity moves both alike from s = 0 on.
  std::array<Flight<Ball<double>>, 2> flights_;
  Vector<double> shift_;
  std::array<Ball<double>, 2> delay_;  ///< time from each record to s = 0
  std::array<double, 2> velocity_;
  double distance_ = 0;  ///< lower bound on |r12| at s = 0
  double offset_ = 0;    ///< correction of f(0) to its value in the previous flight
  double slope_ = 0;     ///< f'(0) of a pair that has just collided and, by rounding, approaches
  std::optional<Precise> precise_;
  // Coefficients of f as a sum of products of the cosine or sine of each needle's angle since its
  // record.
  struct Coefficient {
    double constant, linear;  ///< constant and linear in time; upper bounds on their sizes
  };
  using Coefficients = std::array<std::array<Coefficient, 2>, 2>;
  std::optional<Coefficients> coefficients_;
};

}  // namespace needlework::audit
