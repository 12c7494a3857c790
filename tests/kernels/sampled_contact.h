// Contacts found by looking: the contact function sampled at equal steps. What it finds is there;
// it may overlook two roots within one step.
#pragma once

#include <cmath>
#include <optional>

#include "kernels/first_contact.h"

namespace needlework::test {

/// The first root between two samples of opposite sign, both arms inside there; both samples larger
/// than `noise`, which is far above their rounding. Starts half a step after s = 0, so that a touch
/// there is no root.
inline std::optional<double> sampled_contact(const kernels::Pair& pair, double until, int steps,
                                             double noise = 1e-14) {
  const double step = until / steps;
  const auto gap = [&](double t) { return kernels::gap_at(pair, t); };
  const auto inside = [&](double t) {
    const kernels::ContactGeometry at = kernels::contact_geometry(pair, t);
    return std::abs(at.arm_first) < 0.4999 && std::abs(at.arm_second) < 0.4999;
  };
  double before = gap(0.5 * step);
  for (int n = 1; n < steps; ++n) {
    const double here = gap((n + 0.5) * step);
    if (before * here < 0 && std::abs(before) > noise && std::abs(here) > noise) {
      double low = (n - 0.5) * step, high = low + step;
      for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (gap(middle) * before > 0 ? low : high) = middle;
      }
      if (inside(low)) return low;
    }
    before = here;
  }
  return std::nullopt;
}

}  // namespace needlework::test
