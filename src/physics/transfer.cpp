#include "src/physics/transfer.h"

#include "src/physics/record.h"

namespace needlework {

void transfer(Archive& archive, Vec3d& a) { archive(a.x, a.y, a.z); }
void transfer(Archive& archive, Time& time) { archive(time.epoch, time.offset); }
void transfer(Archive& archive, RecordedTouch& touch) {
  archive(touch.partner.value, touch.partner_serial, touch.shift, touch.side, touch.collided,
          touch.gap);
}

namespace kernels {
void transfer(Archive& archive, Flight& flight) {
  archive(flight.r, flight.v, flight.u, flight.w);
  if (archive.reads()) set_rotation(flight);
}
}  // namespace kernels

}  // namespace needlework
