// The effects on pair rule and free flight that a scene uses. They are chosen at compile time.
#pragma once

namespace needlework {

/// Each combination of effects is a model of its own, so that an unused effect adds no code to the
/// event loop. Effects that are events of their own are kinds of events instead
/// (src/calendar/event.h).
struct Effects {
  bool rough = false;         ///< tangential restitution, beta != -1
  bool contact_time = false;  ///< the t_c rule
  bool table = false;         ///< lengths, masses and inertias depend on the species; otherwise
                              ///< length and mass are 1
};

}  // namespace needlework
