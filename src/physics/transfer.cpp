#include "src/physics/transfer.h"

#include <cstdlib>

#include "src/physics/record.h"

namespace needlework {

void transfer(Archive& archive, Vec3d& a) { archive(a.x, a.y, a.z); }
void transfer(Archive& archive, Time& time) { archive(time.epoch, time.offset); }
// A bond is saved as a collision with twice its side.
void transfer(Archive& archive, RecordedTouch& touch) {
  bool collided = touch.kind != TouchKind::near;
  auto side = static_cast<std::int8_t>(touch.kind == TouchKind::bond ? 2 * touch.side : touch.side);
  archive(touch.partner.value, touch.partner_serial, touch.shift, side, collided, touch.gap);
  if (!archive.reads()) return;
  const bool is_bond = std::abs(side) == 2 && collided;
  touch.kind = is_bond ? TouchKind::bond : collided ? TouchKind::collision : TouchKind::near;
  touch.side = static_cast<std::int8_t>(is_bond ? side / 2 : side);
}

namespace kernels {
void transfer(Archive& archive, Flight& flight) { archive(flight.r, flight.v, flight.u, flight.w); }
}  // namespace kernels

}  // namespace needlework
