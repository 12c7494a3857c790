// What the calendar holds: one event for each needle, its next.
#pragma once

#include <tuple>

#include "src/physics/gas.h"

namespace needlework {

/// What an event is. At one time, events happen in the order of this list; kinds that a scene does
/// not call for never come up. A new kind needs its place here, the data of the event below, and
/// its case in EventProcessor::process (src/engine/event_processor.h).
enum class EventKind : std::uint8_t {
  horizon,  ///< the last search of the owner was cut here and has to be taken up again
  contact,  ///< a collision of the owner with its partner
};

/// The next event of needle `owner`.
struct Event {
  Time time = Time::never();
  Needle owner;
  Needle partner;                    ///< of a contact; else no_needle
  std::uint32_t partner_serial = 0;  ///< of the partner's record; another one: the contact is stale
  Id lower_id;                       ///< ids of the two needles; without a partner both the owner's
  Id higher_id;
  Shift shift{};         ///< of the needle with the higher id, as in make_pair
  std::int8_t side = 0;  ///< sign of the contact function before
  EventKind kind = EventKind::horizon;
  bool resolvable = true;      ///< false: a collapse that the clock or velocities cannot resolve
  bool owner_is_lower = true;  ///< the owner has the lower id

  bool is_contact() const { return kind == EventKind::contact; }
  Needle lower() const { return owner_is_lower ? owner : partner; }
  Needle higher() const { return owner_is_lower ? partner : owner; }

  /// The order of events: time, then kind, lower id, higher id and shift. The two copies of one
  /// contact, one with each partner, are equal in it.
  friend bool operator<(const Event& a, const Event& b) {
    if (a.time != b.time) return a.time < b.time;
    const auto key = [](const Event& e) {
      return std::tuple(e.kind, e.lower_id, e.higher_id, e.shift);
    };
    return key(a) < key(b);
  }
};

static_assert(sizeof(Event) <= 64);

}  // namespace needlework
