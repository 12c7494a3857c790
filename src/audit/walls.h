// Tips of needles and walls: where a needle must not be between its events, and what a hit does.
#pragma once

#include <optional>
#include <vector>

#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "src/audit/guided_flight.h"

namespace needlework::audit {

/// One wall at an end of an axis, in the units of the audit: times in epochs.
struct Wall {
  int axis = 0;
  bool high = false;
  double place = 0;      ///< along the axis, of the surface at rest [L]
  double amplitude = 0;  ///< of its motion [L]
  double frequency = 0;  ///< [cycles / epoch]
  double phase = 0;      ///< [radians]
  double velocity = 0;   ///< along the axis, from time 0 until it comes to rest [L / epoch]
  double stop = 0;       ///< where, if it does [L]
  bool stops = false;
  double epsilon = 1;
  bool draws = false;  ///< all velocities, from a distribution; no rule tells them

  /// Of the normal into the gas, along the axis.
  double sign() const { return high ? -1 : 1; }
};

/// The walls of a scene one by one, `both` as low, then high.
std::vector<Wall> walls_of(const std::vector<Scene::Wall>& walls, const std::array<double, 3>& box,
                           double epoch_length, double unit);

/// Height and speed of one tip of a needle over a wall, from the needle's record on.
class TipFlight {
 public:
  /// `tip` is 1 for the tip at which the director points, else -1.
  TipFlight(const Needle& needle, const Space& space, const Wall& wall, int tip);
  /// The same of a needle that is guided since its record, for this time.
  TipFlight(const Guide& guide, double duration, const Space& space, const Wall& wall, int tip);

  double height(double s) const;  ///< [L]
  double rate(double s) const;    ///< its derivative
  /// The first time in [from, to] at which the tip is further in the wall than `tolerance`.
  std::optional<double> crossing(double from, double to, double tolerance) const;

 private:
  struct Point {
    double place, velocity;  ///< of the tip along the axis, with the wall at 0
  };
  Point tip_at(double s) const;
  double phase(double s) const { return angle_ + turn_ * s; }
  /// Bound on the second derivative up to s.
  double bend(double s) const { return bend_ + growth_ * (2 * turned_ + turned_ * omega_ * s); }

  const JointMotion* joint_ = nullptr;  ///< null in free flight
  int index_ = 0, axis_;
  /// The arm is 1 + growth s times as long at s; the centre counts from where a needle without arms
  /// would touch.
  double growth_, sign_, centre_, speed_, half_fall_, arm_, along_, across_, omega_;
  double amplitude_, turn_, angle_;
  double drift_ = 0, halt_ = 0;  ///< velocity of the surface, and when it comes to rest
  double bend_;                  ///< bound on the second derivative, without growth
  double turned_ = 0;            ///< bound on the speed of the tip by rotation at s = 0
};

/// Largest difference of a reported hit and of the record after it from the rule, in units of what
/// rounding may explain; a value above 1 is an error. `needle` is that before, `now` the time of
/// the hit.
double excess_over_wall_rule(const Needle& needle, const Wall& wall, const Instant& now,
                             const Collision& hit, const Space& space);

/// The same for an event that changes velocities in a way that is not checked: place and director
/// of the needle go on.
double excess_over_flight(const Needle& needle, const Vector<double>& gravity, const Instant& now,
                          const StateAfterCollision& after, const Space& space);

}  // namespace needlework::audit
