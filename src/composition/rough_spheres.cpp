#include "src/composition/rough_spheres.h"

#include "src/composition/sizes.h"

namespace needlework {

void set_q_of_spheres(Composition& composition) {
  for (std::size_t n = 0; n < composition.size(); ++n) {
    bool is_rough = false;
    for (std::size_t other = 0; other < composition.size(); ++other) {
      is_rough = is_rough || (composition.are_spheres(n, other) &&
                              composition.restitution(n, other).is_rough());
    }
    Species species = composition[n];
    species.q = !is_rough ? 0 : species.q > 0 ? species.q : q_of_homogeneous;
    composition.set_species(n, species);
  }
}

}  // namespace needlework
