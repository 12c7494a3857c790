#include "src/audit/guided_flight.h"

#include <algorithm>
#include <cmath>

#include "src/audit/tolerances.h"

namespace needlework::audit {

GuidedFlight::GuidedFlight(const Guide& first, const Guide& second, const Shift& shift,
                           const Space& space, const Start& start, double duration)
    : PairMotion(first.needle.body, second.needle.body,
                 space.around(first.needle.record.r).around(second.needle.record.r), start),
      trajectories_{Trajectory(first, space.gravity), Trajectory(second, space.gravity)},
      image_() {
  for (int axis = 0; axis < 3; ++axis) image_[axis] = Extended(shift[axis]) * space.box[axis];
  bound(duration);
  if (rate() > 0) bound(duration + 2 * early_reach / rate());
  if (start.kind == Start::collided) {
    offset_ = sample(0).f;
  } else if (start.gap) {
    offset_ = sample(0).f - *start.gap;
  }
}

// What gravity does from s = 0 on, it does to both.
GuidedFlight::Trajectory::Trajectory(const Guide& guide, const Vector<double>& gravity)
    : joint(guide.joint),
      index(guide.index),
      delay(guide.delay),
      flight(guide.needle.record),
      fallen(to<Extended>(gravity) * (Extended(delay) * delay / 2)),
      falls(to<Extended>(gravity) * Extended(delay)) {}

void GuidedFlight::bound(double duration) {
  std::array<JointMotion::Most, 2> most;
  speed_ = spin_ = acceleration_ = turned_faster_ = spread_ = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    Trajectory& trajectory = trajectories_[i];
    if (trajectory.joint) {
      trajectory.joint->follow(trajectory.delay + duration);
      spread_ += trajectory.joint->spread(trajectory.index, trajectory.delay + duration);
    }
    most[i] = trajectory.most(duration);
    omega_[i] = most[i].turning;
    speed_ += most[i].speed;
    spin_ += most[i].turning;
    acceleration_ += most[i].acceleration;
    turned_faster_ += most[i].turned_faster;
  }
  hurry_ = std::sqrt(acceleration_ / size() + turned_faster_);
}

BodyState GuidedFlight::Trajectory::at(double s) const {
  BodyState out;
  if (joint) {
    out = joint->at(index, delay + s);
  } else {
    const Pose<Extended> pose = flight.at(Extended(delay) + s);
    out = {pose.r, flight.v, pose.u, pose.du};
  }
  out.r = out.r + fallen + falls * Extended(s);
  out.v = out.v + falls;
  return out;
}

JointMotion::Most GuidedFlight::Trajectory::most(double duration) const {
  JointMotion::Most out;
  if (joint) {
    out = joint->most(index, delay, delay + duration);
  } else {
    out = {.speed = static_cast<double>(norm(flight.v)) * upward,
           .turning = static_cast<double>(flight.omega) * upward};
  }
  out.speed += static_cast<double>(norm(falls)) * upward;
  return out;
}

Sample GuidedFlight::sample(double s) const {
  const BodyState a = trajectories_[0].at(s), b = trajectories_[1].at(s);
  const Vector<Extended> r = a.r - b.r - image_, x = cross(a.u, b.u);
  const Vector<Extended> dx = cross(a.du, b.u) + cross(a.u, b.du);
  Sample out;
  out.f = static_cast<double>(dot(r, x) - offset_);
  out.df = static_cast<double>(dot(a.v - b.v, x) + dot(r, dx));
  out.distance = static_cast<double>(norm(r)) * upward;
  const Extended xx = dot(x, x);
  out.sine = static_cast<double>(std::sqrt(xx)) * upward;
  // What the arithmetic loses, also where double is all that there is; of f it is far less than the
  // limit, which alone decides.
  const double lost = 0x1p-50 * (out.distance + size());
  out.f_error = 0;
  out.df_error = lost * rate();
  const std::array<Vector<Extended>, 2> moments = {cross(b.u, r), cross(a.u, r)};
  for (int i = 0; i < 2; ++i) {
    const double moment = static_cast<double>(norm(moments[i]));
    out.moment_least[i] = std::max(0.0, moment - lost);
    out.moment_most[i] = moment + lost;
    out.margin[i] = static_cast<double>(xx * half_lengths_[i] - std::abs(dot(moments[i], x)));
    out.margin_error[i] = lost;
  }
  return out;
}

// |f''| <= |v12'| + 2 |v12| W + |r12| (W^2 + |w1'| + |w2'|).
double GuidedFlight::bend(double, double, double distance) const {
  return (acceleration_ + 2 * speed_ * spin_ + distance * (spin_ * spin_ + turned_faster_)) *
         upward;
}

// Places are uncertain by what steps of the engine leave over, and by what it loses of centres as
// it adds up their trajectory, directors by the former.
double GuidedFlight::limit(const Sample& sample, double, double half) const {
  const double distance = sample.distance + speed_ * half, noise = contact_noise + spread_;
  return (space_.rounding() + noise * size()) * std::min(1.0, sample.sine + spin_ * half) +
         noise * distance + start_.gap_error;
}

double GuidedFlight::margin_limit(const Sample& sample, double) const {
  return 4 * (space_.rounding() + (contact_noise + spread_) * (size() + sample.distance));
}

}  // namespace needlework::audit
