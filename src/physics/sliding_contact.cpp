#include "src/physics/sliding_contact.h"

#include <cmath>

#include "src/physics/gas.h"

namespace needlework {
namespace {

// A contact keeps f at 0, on its side: less than any f that can be told from 0.
constexpr double least_gap = 0x1p-1000;

bool refers_to(const Record& record, Id other) {
  return record.is_sliding() && record.first_touch.partner == other;
}

// Calls what(pair) with both trajectories.
template <class What>
auto with_trajectories(const SlidingPair& pair, const What& what) {
  const NeedleTrajectory first(*pair.gas, pair.id_first, *pair.record_first, pair.slide_first,
                               to_double(pair.elapsed_first));
  const NeedleTrajectory second(*pair.gas, pair.id_second, *pair.record_second, pair.slide_second,
                                to_double(pair.elapsed_second));
  return what(kernels::TrajectoryPair{first, second, to_double(pair.shift), pair.half_first,
                                      pair.half_second, pair.touch, pair.touch_within});
}

}  // namespace

void SlidingPair::look_up(const Gas& its_gas, const Needle& a, const Needle& b,
                          const Shift& shift_of_second) {
  first_needle = a.index;
  second_needle = b.index;
  if (!a.record.is_sliding() && !b.record.is_sliding()) return;
  gas = &its_gas;
  record_first = &a.record;
  record_second = &b.record;
  id_first = gas->ids[a.index];
  id_second = gas->ids[b.index];
  if (a.record.is_sliding()) slide_first = gas->slides->of(id_first, a.record);
  if (b.record.is_sliding()) slide_second = gas->slides->of(id_second, b.record);
  const bool first_refers = refers_to(a.record, id_second),
             second_refers = refers_to(b.record, id_first);
  if (!first_refers && !second_refers) return;
  const RecordedTouch &mine = a.record.first_touch, &its = b.record.first_touch;
  if (first_refers && second_refers && mine.is_with(id_second, b.record.serial, shift_of_second) &&
      its.is_with(id_first, a.record.serial, -shift_of_second)) {
    bond = Bond::whole;
  } else {
    // Of all images, that of the contact is the one which is near.
    const double near = half_first + half_second;
    const bool is_near = with_trajectories(*this, [&](const kernels::TrajectoryPair& pair) {
      const Vec3d apart = (pair.first.at(0).r - pair.second.at(0).r) - pair.shift;
      return dot(apart, apart) < near * near * (1 + 0x1p-20);
    });
    const bool is_old = (first_refers && mine.partner_serial != b.record.serial) ||
                        (second_refers && its.partner_serial != a.record.serial);
    if (!is_near || !is_old) return;
    bond = Bond::cut;
  }
  joint_is_first = first_refers;
  touch = {};
}

kernels::Contact SlidingContact::first_contact(const Pair& pair, double from, double to,
                                               kernels::EvaluationCounters& spent) const {
  if (!pair.any_slides()) return free_.first_contact(pair, from, to, spent);
  if (pair.bond == Pair::Bond::none) {
    return with_trajectories(pair, [&](const kernels::TrajectoryPair& trajectories) {
      return kernels::trajectory_contact(trajectories, from, to, spent);
    });
  }
  kernels::Contact out;
  out.elapsed = DoubleDouble(pair.bond == Pair::Bond::whole ? pair.joint().step.duration : 0);
  out.side = pair.joint().side;
  out.found = out.elapsed.hi <= to;
  return out;
}

double SlidingContact::gap(const Pair& pair, const DoubleDouble& elapsed) const {
  if (!pair.any_slides()) return free_.gap(pair, elapsed);
  if (pair.bond != Pair::Bond::none) return pair.joint().side * least_gap;
  return with_trajectories(pair, [&](const kernels::TrajectoryPair& trajectories) {
    return kernels::trajectory_gap(trajectories, to_double(elapsed));
  });
}

int SlidingContact::side_after(const Pair& pair) const {
  if (!pair.any_slides()) return free_.side_after(pair);
  if (pair.bond != Pair::Bond::none) return pair.joint().side;
  return with_trajectories(pair, kernels::trajectory_side_after);
}

kernels::ContactGeometry SlidingContact::geometry(const Pair& pair,
                                                  const DoubleDouble& elapsed) const {
  if (!pair.any_slides()) return free_.geometry(pair, elapsed);
  return with_trajectories(pair, [&](const kernels::TrajectoryPair& trajectories) {
    return kernels::trajectory_geometry(trajectories, to_double(elapsed));
  });
}

}  // namespace needlework
