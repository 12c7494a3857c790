#include "needlework/theory.h"
#include "src/composition/convex_body.h"

namespace needlework::theory {

// Half of what one rod excludes the centre of another from, averaged over their directions:
// <sin> = pi / 4.
double second_virial(const Composition& composition) {
  const double count = static_cast<double>(composition.count());
  double out = 0;
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = 0; b < composition.size(); ++b) {
      if (!composition.meets(a, b)) continue;
      const double share = static_cast<double>(composition[a].count) / count *
                           (static_cast<double>(composition[b].count) / count);
      out += share * 0.5 * excluded_volume(composition[a], composition[b]);
    }
  }
  return out;
}

}  // namespace needlework::theory
