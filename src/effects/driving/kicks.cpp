#include "src/effects/driving/kicks.h"

#include <cmath>

#include "src/physics/director.h"
#include "src/physics/vectors.h"
#include "src/random/needle_random.h"

namespace needlework {

// A product, not a sum, so that kicks do not drift. Rounded as a caller rounds it who asks for the
// time of ten kicks: ten intervals of 0.05 end at 0.5.
Time Kicks::time(const Clock& clock, std::uint64_t n) const {
  return clock.add({}, static_cast<double>(n) * parameters_.every);
}

Kicks::Change Kicks::change(Id id, std::uint64_t n, const Body& body, const Vec3d& director) const {
  NeedleRandom random(parameters_.seed, id.value, RandomFor::kick, n);
  const double root = std::sqrt(parameters_.every);
  Change out;
  out.velocity = vector_of(random.normal()) * (parameters_.translational * root);
  out.angular_velocity =
      turned(body, vector_of(random.normal()) * (parameters_.rotational * root), director);
  return out;
}

std::vector<double> Kicks::parameters() const {
  const auto [low, high] = halves(parameters_.seed);
  return {parameters_.every, parameters_.translational, parameters_.rotational, low, high};
}

}  // namespace needlework
