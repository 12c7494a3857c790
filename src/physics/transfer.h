// What archives save of times, flights and touches.
#pragma once

#include "kernels/contact_function.h"
#include "src/archive/archive.h"
#include "src/physics/clock.h"

namespace needlework {

struct RecordedTouch;

void transfer(Archive& archive, Vec3d& a);
void transfer(Archive& archive, Time& time);
void transfer(Archive& archive, RecordedTouch& touch);

namespace kernels {
/// Without p and omega, which follow from the others and the body (set_rotation() of a gas).
void transfer(Archive& archive, Flight& flight);
}  // namespace kernels

}  // namespace needlework
