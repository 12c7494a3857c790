// What C callers get with the totals.
#pragma once

#include <string_view>

#include "needlework/totals.h"

namespace needlework::c {

/// The totals and what stands beside them in needlework_totals.
struct AllTotals {
  Totals sums;
  double initial_energy = 0, mean_free_time = 0, epoch_length = 0;

  template <class Visit>
  void for_each(const Visit& visit) const {
    sums.for_each([&](const Described& number, const auto& value) {
      visit(number, value);
      if (std::string_view(number.name) == "energy") {
        visit(Described{"initial_energy", unit::energy,
                        "Energy per needle at the start; NaN without needles"},
              initial_energy);
      }
    });
    visit(Described{"mean_free_time", unit::time,
                    "Mean free time by kinetic theory, at about the present temperatures; may be "
                    "infinite"},
          mean_free_time);
    visit(Described{"epoch_length", unit::time, "Length of an epoch of needlework_collision"},
          epoch_length);
  }
};

}  // namespace needlework::c
