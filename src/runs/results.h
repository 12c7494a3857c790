// The kinds of results that a run has, for whoever has all of them to say.
#pragma once

#include "needlework/totals.h"
#include "src/observe/rod_totals.h"

namespace needlework::runs {

/// A kind of result by its key in JSON; the numbers of "totals" have no object of their own.
struct ResultKind {
  const char* key;
  const char* meaning;
};

/// Calls visit(kind, sums) for each kind, with sums that have all their numbers.
template <class Visit>
void for_each_result(Visit&& visit) {
  visit(ResultKind{"totals", "Sums over all needles at one instant"}, Totals{});
  visit(ResultKind{"species", "Needles of one species at one instant"}, SpeciesTotals{});
  visit(ResultKind{"rods", "Room and pressure of rods of finite width"}, observe::RodTotals{});
  visit(ResultKind{"growth", "Sizes, packing and pressure of bodies that grow"}, GrowthTotals{});
  visit(ResultKind{"walls", "Hits on one wall since the start"}, WallTotals{});
  visit(ResultKind{"contacts", "Contacts of needles that slide on each other, since the start"},
        SlidingContacts{});
  visit(ResultKind{"pressure_tensor",
                   "Pressure tensor since the start, a mean over the run. The first letter of an "
                   "index is the axis along which momentum goes, the second its component"},
        StressTotals{});
  visit(ResultKind{"energy_budget",
                   "What each effect has put into the energy per needle since the start; negative: "
                   "taken out. The sum is the change of the energy, up to rounding"},
        EnergyBudget{}.complete());
}

}  // namespace needlework::runs
