// The next event of a needle, as calendars hold it.
#pragma once

#include <tuple>

#include "src/physics/gas.h"

namespace needlework {

/// The kinds of events. Events at the same time are processed in the order of this list, those of
/// sources in the order of the sources. Kinds that a scene does not use do not occur.
enum class EventKind : std::uint8_t {
  horizon,  ///< the last search of the owner ended here and has to be continued
  contact,  ///< a collision of the owner with its partner
  source,   ///< an event of the owner by a source (src/effects/event_source.h)
};

/// The next event of needle `owner`.
struct Event {
  Time time = Time::never();
  Needle owner;
  Needle partner = no_needle;        ///< the second needle of a contact
  std::uint32_t partner_serial = 0;  ///< of the partner's record; if the partner's has changed, the
                                     ///< contact is stale
  Id lower_id;                       ///< ids of the two needles; without a partner both are the
                                     ///< owner's
  Id higher_id;
  Shift shift{};         ///< boxes added to the centre of the needle with the higher id, as in
                         ///< make_pair
  std::int8_t side = 0;  ///< sign of the contact function before the contact; of an event of a
                         ///< source: SourceEvent::detail
  EventKind kind = EventKind::horizon;
  std::uint8_t source = 0;     ///< index of the source, if it is an event of one
  bool resolvable = true;      ///< false: a collapse, which the resolution of time or velocities
                               ///< cannot resolve
  bool owner_is_lower = true;  ///< the owner has the lower id

  bool is_contact() const { return kind == EventKind::contact; }
  /// Whether processing the event may change a second needle, the partner.
  bool has_partner() const { return partner != no_needle; }
  Needle lower() const { return owner_is_lower ? owner : partner; }
  Needle higher() const { return owner_is_lower ? partner : owner; }

  /// The order of events: by time, then kind, source, lower id, higher id and shift. The two copies
  /// of one contact, one for each needle, are equal in this order.
  friend bool operator<(const Event& a, const Event& b) {
    if (a.time != b.time) return a.time < b.time;
    const auto key = [](const Event& e) {
      return std::tuple(e.kind, e.source, e.lower_id, e.higher_id, e.shift);
    };
    return key(a) < key(b);
  }
};

static_assert(sizeof(Event) <= 64);

}  // namespace needlework
