// The effects on flight and pair rule that a scene calls for.
#pragma once

namespace needlework {

/// Six models are compiled: one without any of these, to which they cost nothing, one that asks
/// for each of them when it runs, those for rods, for spheres and for thin needles among these, and
/// that for needles that slide on each other (src/physics/needle_model.h). Effects that are events
/// of their own are sources of events instead (src/effects/event_source.h).
struct Effects {
  bool rough = false;         ///< tangential restitution, beta != -1
  bool contact_time = false;  ///< the t_c rule
  bool table = false;         ///< lengths, masses, inertias and restitution depend on the species;
                              ///< otherwise length and mass are 1
  bool passing = false;       ///< bodies of some species pass through each other

  bool width = false;    ///< rods of finite width
  bool spheres = false;  ///< all of these are spheres
  bool mixed = false;    ///< thin needles are among them
  bool sliding = false;  ///< needles slide on each other
  bool sources = false;  ///< there are sources of events
  bool kicks = false;    ///< the velocities of all needles change at one instant, again and again
  bool gravity = false;  ///< needles fall freely between events
  bool shear = false;    ///< rows of boxes slide
  bool stress = false;   ///< the pressure tensor is measured
  bool growth = false;   ///< bodies grow

  bool any() const {
    return rough || contact_time || table || passing || width || spheres || mixed || sliding ||
           sources || kicks || gravity || shear || stress || growth;
  }
};

}  // namespace needlework
