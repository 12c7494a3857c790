// What the pair rule and the flight of a scene call for, chosen at compile time.
#pragma once

namespace needlework {

/// Each combination is a model of its own, compiled apart, so that an effect that is off has no
/// code in the event loop. Effects that are events of their own are kinds of events instead
/// (src/calendar/event.h).
struct Effects {
  bool rough = false;         ///< tangential restitution, beta != -1
  bool contact_time = false;  ///< the t_c rule
  bool table = false;         ///< lengths, masses and inertias by species; else 1, 1 and k
};

}  // namespace needlework
