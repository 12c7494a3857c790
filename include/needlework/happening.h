// What changes the motion of needles, as the engine reports it.
#pragma once

#include <cstdint>

#include "needlework/collision.h"

namespace needlework {

/// A collision of two needles, or an event of one needle that a source of events has caused
/// (Simulation::sources() names them), such as a hit on a wall.
struct Happening {
  /// What it is; the numbers are those of /events/kind in files, and of C, Python and serve.
  enum Kind : std::uint8_t {
    pair = 0,             ///< a collision of two needles
    wall = 1,             ///< a hit on a wall
    contact_entered = 2,  ///< two needles have begun to slide on each other
    contact_ended = 3,    ///< and have ended
    thermostat = 4,       ///< velocities drawn anew by a thermostat
    other = 255           ///< an event of a source that has no number of its own
  };

  Kind kind = pair;
  /// 0: two needles have collided; n: the event is one of source n - 1 of Simulation::sources().
  std::uint8_t source = 0;
  /// Of an event of one needle: `first` is its id, `second` what the source says of it (such as the
  /// index of the wall); `shift` and `arm_second` are 0, and the second state after it is not set.
  Collision event;

  bool is_collision() const { return kind == pair || kind == contact_entered; }
  /// Whether `event.second` and the second state after it are those of a needle.
  bool has_two_needles() const { return source == 0; }
};

/// One word for a kind, such as "pair" or "wall".
constexpr const char* name_of(Happening::Kind kind) {
  switch (kind) {
    case Happening::pair:
      return "pair";
    case Happening::wall:
      return "wall";
    case Happening::contact_entered:
      return "contact entered";
    case Happening::contact_ended:
      return "contact ended";
    case Happening::thermostat:
      return "thermostat";
    case Happening::other:
      break;
  }
  return "other";
}

}  // namespace needlework
