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
  Shift shift{};                     ///< of the needle with the higher index, as in make_pair
  std::int8_t side = 0;              ///< sign of the contact function before
  bool resolvable = true;            ///< false: a collapse that the clock or velocities lose

  bool is_contact() const { return partner != no_needle; }
  Needle lower() const { return is_contact() ? std::min(owner, partner) : owner; }
  Needle higher() const { return is_contact() ? std::max(owner, partner) : owner; }

  /// The order of events: time, then horizons before contacts, then lower index, higher index and
  /// shift. The two copies of one contact, one with each partner, are equal in it.
  friend bool operator<(const Event& a, const Event& b) {
    if (a.time != b.time) return a.time < b.time;
    const auto key = [](const Event& e) {
      return std::tuple(e.is_contact(), e.lower(), e.higher(), e.shift);
    };
    return key(a) < key(b);
  }
};

}  // namespace needlework
