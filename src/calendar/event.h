// What the calendar holds: one event for each needle, its next.
#pragma once

#include <tuple>

#include "src/physics/gas.h"

namespace needlework {

/// The next event of needle `owner`. Either a contact that its last search found, or the horizon at
/// which that search was cut and has to be taken up again.
struct Event {
  Time time = Time::never();
  Needle owner = no_needle;
  Needle partner = no_needle;        ///< no_needle: the horizon
  std::uint32_t partner_serial = 0;  ///< of the partner's record; another one: the contact is stale
  std::uint32_t lower_id = 0;        ///< ids of the two needles; of a horizon, both its owner's
  std::uint32_t higher_id = 0;
  Shift shift{};               ///< of the needle with the higher id, as in make_pair
  std::int8_t side = 0;        ///< sign of the contact function before
  bool resolvable = true;      ///< false: a collapse that the clock or velocities lose
  bool owner_is_lower = true;  ///< the owner has the lower id

  bool is_contact() const { return partner != no_needle; }
  Needle lower() const { return owner_is_lower ? owner : partner; }
  Needle higher() const { return owner_is_lower ? partner : owner; }

  /// The order of events: time, then horizons before contacts, then lower id, higher id and shift.
  /// The two copies of one contact, one with each partner, are equal in it.
  friend bool operator<(const Event& a, const Event& b) {
    if (a.time != b.time) return a.time < b.time;
    const auto key = [](const Event& e) {
      return std::tuple(e.is_contact(), e.lower_id, e.higher_id, e.shift);
    };
    return key(a) < key(b);
  }
};

static_assert(sizeof(Event) <= 64);

}  // namespace needlework
