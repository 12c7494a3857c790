#include "kernels/trajectory_wall.h"

#include <algorithm>
#include <cmath>

#include "kernels/root_between.h"

namespace needlework::kernels {
namespace {

constexpr double whole_turn = 0x1.921fb54442d18p+2;
constexpr int last_halving = 60;
// Relative to lengths and to speeds: what rounding may do to the places of needles that slide, and
// to their velocities.
constexpr double place_noise = 0x1p-40, speed_noise = 0x1p-44;

struct TipHeight {
  double h, dh;
};

// The contact of one tip.
class TrajectoryTip {
 public:
  TrajectoryTip(const Trajectory& trajectory, const WallApproach& approach, int tip)
      : trajectory_(trajectory),
        given_(approach),
        sign_(approach.wall.normal),
        arm_(tip == 0 ? approach.half : -approach.half) {
    const double rate = approach.wall.amplitude > 0 ? whole_turn * approach.wall.frequency : 0;
    const double swing = approach.wall.amplitude * rate;
    speed_ = (trajectory.speed + approach.half * trajectory.turning + swing +
              std::abs(approach.wall.velocity)) *
             roundup;
    const double turned =
        approach.half * (trajectory.turning * trajectory.turning + trajectory.turning_faster);
    bend_ = (trajectory.acceleration + turned + swing * rate) * roundup;
  }

  // Of a tip that has just hit the wall, or is there to within rounding, the height is continued
  // from 0, and so is a speed that rounding has turned towards the wall.
  enum class Start { above, leaves, hits, across };
  Start start(bool touching) {
    const TipHeight first = at(0);
    const double size = std::abs(component(trajectory_.at(0).r, given_.wall.axis)) + given_.half;
    if (!touching && first.h > 0x1p-48 * size) return Start::above;
    const double within =
        given_.tolerance + 4 * given_.resolution * speed_ + place_noise * given_.half;
    if (first.h < -within) return Start::across;
    if (first.dh < -speed_noise * speed_) return Start::hits;
    zero_ = first.h;
    drift_ = std::min(first.dh, 0.0);
    starts_ = true;
    return Start::leaves;
  }

  // After start(): the first contact between 0 and the end of the trajectory; infinite if there is
  // none from `from` up to `to`.
  double first(double from, double to) {
    from_ = from;
    until_ = to;
    // Where the wall comes to rest, the height has a kink.
    const double last = trajectory_.lasts, kink = std::clamp(given_.wall.halt, 0.0, last);
    double out = INFINITY;
    if (kink > 0 && search(0, kink, 0, out)) return out;
    if (last > kink) search(kink, last, 0, out);
    return out;
  }

 private:
  TipHeight at(double s) const {
    const int axis = given_.wall.axis;
    const BodyState there = trajectory_.at(s);
    const WallSurface surface = surface_at(
        given_.wall, given_.turns + DoubleDouble(given_.wall.frequency) * DoubleDouble(s), s);
    const double place = component(there.r, axis) + arm_ * component(there.u, axis);
    const double speed = component(there.v, axis) + arm_ * component(cross(there.w, there.u), axis);
    return {sign_ * (place - surface.place) - (zero_ + drift_ * s),
            sign_ * (speed - surface.velocity) - drift_};
  }

  bool accept(double s, double& out) const {
    if (s > until_) return false;
    out = s;
    return true;
  }

  // The height at `begin` is not below 0 but by rounding.
  bool search(double begin, double end, int halvings, double& out) const {
    if (end < from_ || begin > until_) return false;
    const bool starts = starts_ && begin == 0;
    const double half = 0.5 * (end - begin), middle = begin + half;
    if (halvings == last_halving || !(begin < middle && middle < end))
      return at(end).h < 0 && accept(starts ? 0 : end, out);
    const TipHeight here = at(middle);
    const double slope = std::abs(here.dh);
    if (here.h > (slope + 0.5 * bend_ * half) * half * roundup) return false;
    if (slope > bend_ * half * roundup) {
      // It is monotone, so that a tip that rises has been above 0 before.
      if (here.dh > 0 || !(at(end).h < 0)) return false;
      return accept(starts ? 0 : root(begin, end), out);
    }
    return search(begin, middle, halvings + 1, out) || search(middle, end, halvings + 1, out);
  }

  // Of a height that falls.
  double root(double low, double high) const {
    return root_between(
        low, high, RootSide::before, [&](double s) { return at(s); },
        [](double h) { return h < 0; });
  }

  const Trajectory& trajectory_;
  const WallApproach& given_;
  const double sign_, arm_;
  double speed_, bend_;
  double zero_ = 0, drift_ = 0, from_ = 0, until_ = 0;
  bool starts_ = false;
};

// Whether no tip comes to the wall while the trajectory is known. That is so for most needles.
bool stays_away(const Trajectory& trajectory, const WallApproach& approach) {
  const WallPlane& wall = approach.wall;
  const double height =
      wall.normal * (component(trajectory.at(0).r, wall.axis) - to_double(wall.place));
  const double near = approach.half + std::max(wall.amplitude, 0.0) +
                      (trajectory.speed + std::abs(wall.velocity)) * trajectory.lasts;
  return height > near * (1 + 0x1p-40) + 0x1p-40 * std::abs(height);
}

}  // namespace

WallContact trajectory_wall_contact(const Trajectory& trajectory, const WallApproach& approach,
                                    double from, double to) {
  WallContact out;
  if (stays_away(trajectory, approach)) return out;
  for (int tip = 0; tip < 2; ++tip) {
    const bool touching = approach.touching >> tip & 1;
    TrajectoryTip search(trajectory, approach, tip);
    const TrajectoryTip::Start start = search.start(touching);
    if (start == TrajectoryTip::Start::across) return {.found = true, .tip = tip, .across = true};
    const double at = start == TrajectoryTip::Start::hits ? 0 : search.first(from, to);
    if (std::isinf(at) || (out.found && at >= out.elapsed)) continue;
    out.found = true;
    out.elapsed = to = at;
    out.tip = tip;
    out.unresolvable = touching && at > 0 && at < 64 * approach.resolution;
  }
  return out;
}

}  // namespace needlework::kernels
