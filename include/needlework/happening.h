// What changes the motion of needles, as the engine reports it.
#pragma once

#include <cstdint>

#include "needlework/collision.h"

namespace needlework {

/// A collision of two needles, or an event of one needle that a source of events has caused
/// (Simulation::sources() names them), such as a hit on a wall.
struct Happening {
  /// 0: two needles have collided; n: the event is one of source n - 1.
  std::uint8_t kind = 0;
  /// Of an event of one needle: `first` is its id, `second` what the source says of it (such as the
  /// index of the wall); `shift` and `arm_second` are 0, and the second state after it is not set.
  Collision event;

  bool is_collision() const { return kind == 0; }
};

}  // namespace needlework
