// What results say of rods of finite width: how much room they take up, and their pressure.
#pragma once

#include <limits>

#include "needlework/described.h"

namespace needlework::observe {

struct RodTotals {
  double packing_fraction = 0;
  double virial = 0;                                           ///< Simulation::virial()
  double pressure = std::numeric_limits<double>::quiet_NaN();  ///< by Pressure
  const char* pressure_meaning = "";                           ///< Pressure::meaning()

  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    visit(Described{"packing_fraction", unit::none,
                    "Share of the volume of the box that rods take up"},
          packing_fraction);
    visit(Described{"virial", unit::virial,
                    "Sum of r12 . dp over the collisions since the start of the run, r12 from the "
                    "second centre to the first and dp the impulse on the first"},
          virial);
    visit(Described{"pressure", unit::pressure,
                    "Mean over the run: N T_tr and a third of what the virial gains in a unit of "
                    "time, over the volume of the box; where there are walls, what all of them "
                    "feel, over their area; NaN at its start, and with gravity along an axis with "
                    "walls"},
          pressure);
  }
};

}  // namespace needlework::observe
