// Two needles in contact: how they slide on each other, and when that ends.
//
// Lagrange's equations of r = r1 - r2, u1 and u2 under the constraints f = r . (u1 x u2) = 0 and
// |u| = 1. With the multiplier mu of the first one, x = u1 x u2, g1 = u2 x r and g2 = r x u1, which
// are the derivatives of f,
//
//   r'' = (1/m1 + 1/m2) mu x,  u1'' = mu g1 / I1 - |u1'|^2 u1,  u2'' = mu g2 / I2 - |u2'|^2 u2,
//
// and mu follows from f'' = 0. The force on the first needle is mu x. The centre of mass moves
// uniformly. Each step is a Taylor series whose coefficients follow from these equations one after
// the other, so that rates of change, and bounds on them, are known at all times.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "src/audit/touch.h"

namespace needlework::audit {

/// Centre, director and their rates of change at one time.
struct BodyState {
  Vector<Extended> r, v, u, du;
};

class JointMotion {
 public:
  /// The contact begins with these records, of one time; `r12` is r1 - r2 of the image in contact,
  /// `side` the sign of f before, and `rounding` what may be lost of centres in records. [L]
  JointMotion(const Needle& first, const Needle& second, const Vector<double>& r12, int side,
              double rounding = 0);
  /// Of needles of which only the relative motion matters, and no spread.
  JointMotion(const RelativeState& begin, const std::array<AuditedBody, 2>& bodies, int side);

  int side() const { return side_; }
  /// Computes the motion until this time after its begin, which what follows needs. False if it
  /// cannot be resolved.
  bool follow(double until);
  /// Needle 0 or 1 at a time until which the motion has been computed.
  BodyState at(int needle, double s) const;
  /// Both then, relative to each other.
  RelativeState state_at(double s) const;
  Touch touch_at(double s) const { return Touch(state_at(s), bodies_); }

  /// Bounds that hold from `begin` to `end`, of centre and director of one needle.
  struct Most {
    double speed = 0, acceleration = 0;     ///< [L / time], [L / time^2]
    double turning = 0, turned_faster = 0;  ///< |u'| and |w'| [1 / time], [1 / time^2]
  };
  Most most(int needle, double begin, double end) const;
  /// By so much small differences at the beginning may have grown: 1 and, for all steps, by how
  /// much the contact has changed.
  double grown(double s) const { return step_at(s).grown; }
  /// By what share of its length, of 1 and of relative velocities the rounding of numbers at the
  /// beginning may have moved one needle by a time, apart from what grown() says: what motions that
  /// begin next to this one have become.
  double spread(int needle, double s) const;

  /// What is positive while the contact lasts: the push of the force, and the room between each
  /// contact point and both tips of its needle.
  static constexpr int rooms = 5;
  /// Each at one time, with its rate of change, and how uncertain it is.
  struct Room {
    double value, rate, noise;
    bool is_of_force;
  };
  std::array<Room, rooms> rooms_at(double s) const;
  /// The first time in [from, to] at which one of them is below this multiple of its noise.
  std::optional<double> first_below(double noises, double from, double to) const;

 private:
  static constexpr int order = 24;
  using Series = std::array<Extended, order + 1>;
  using VectorSeries = std::array<Series, 3>;

  struct Step {
    double begin = 0, span = 0, grown = 1;
    VectorSeries r{}, u1{}, u2{};
    std::array<Series, rooms> room{};
    Extended force_scale = 0;  ///< of f'' without a force
  };

  Step step_from(const RelativeState& state, double begin) const;
  const Step& step_at(double s) const;
  std::optional<double> below(const Step& step, const Series& room, Extended level, double low,
                              double high, int depth) const;
  void add_neighbours(double rounding);
  double noise_of(int room, double s) const;

  std::array<AuditedBody, 2> bodies_;
  int side_;
  std::array<Extended, 2> share_;  ///< of the mass, that of the other needle
  Extended inverse_mass_;          ///< 1/m1 + 1/m2
  std::array<Extended, 2> inverse_inertia_;
  std::array<Vector<Extended>, 2> centre_;  ///< of the needles at the beginning
  Vector<Extended> apart_, drift_;          ///< r at the beginning; velocity of the centre of mass
  std::vector<Step> steps_;
  RelativeState last_;                   ///< at the end of the last step
  bool is_lost_ = false;                 ///< whether it cannot be resolved from there on
  double known_ = 0;                     ///< until when the motion has been computed
  std::vector<JointMotion> neighbours_;  ///< that begin a little aside
};

}  // namespace needlework::audit
