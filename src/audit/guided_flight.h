// Two needles and one periodic image where at least one of them does not fly freely, but slides on
// a third needle: the contact function, and bounds on how it may bend.
#pragma once

#include <optional>

#include "src/audit/joint_motion.h"

namespace needlework::audit {

/// How one needle moves, freely or in contact.
struct Guide {
  const Needle& needle;
  JointMotion* joint = nullptr;  ///< null if it flies freely
  int index = 0;                 ///< 0 or 1 of the needles in contact
  double delay = 0;              ///< from its record, or the beginning of the contact, to s = 0
};

class GuidedFlight final : public PairMotion {
 public:
  /// From s = 0 to `duration`, and for a while after it.
  GuidedFlight(const Guide& first, const Guide& second, const Shift& shift, const Space& space,
               const Start& start, double duration);

  Sample sample(double s) const override;
  Sample precise(double s) override { return sample(s); }
  bool needed_quad() const override { return false; }
  double bend(double begin, double end, double distance) const override;
  double limit(const Sample& sample, double s, double half = 0) const override;
  double margin_limit(const Sample& sample, double s) const override;

 private:
  struct Trajectory {
    JointMotion* joint;
    int index;
    double delay;
    Flight<Extended> flight;
    Vector<Extended> fallen, falls;  ///< what gravity has made of place and velocity until s = 0

    Trajectory(const Guide& guide, const Vector<double>& gravity);
    BodyState at(double s) const;
    JointMotion::Most most(double duration) const;
  };
  void bound(double duration);

  std::array<Trajectory, 2> trajectories_;
  Vector<Extended> image_;  ///< where the second needle's box is
  double spread_ = 0;       ///< of both, as JointMotion::spread()
  Extended offset_ = 0;     ///< correction of f(0) to its value in the previous flight
};

}  // namespace needlework::audit
