#include <numbers>

#include "needlework/theory.h"

namespace needlework::theory {

// Half of what one rod excludes the centre of another from, averaged over their directions:
// <sin> = pi / 4.
double second_virial(const Composition& composition) {
  constexpr double pi = std::numbers::pi;
  const double count = static_cast<double>(composition.count());
  double out = 0;
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = 0; b < composition.size(); ++b) {
      const double share = static_cast<double>(composition[a].count) / count *
                           (static_cast<double>(composition[b].count) / count);
      const double length_a = composition[a].length, length_b = composition[b].length;
      const double width = composition.contact_distance(a, b);
      out += share * 0.5 *
             (0.5 * pi * width * length_a * length_b +
              pi * width * width * (length_a + length_b + 4.0 / 3 * width));
    }
  }
  return out;
}

}  // namespace needlework::theory
