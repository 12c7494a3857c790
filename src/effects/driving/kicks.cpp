#include "src/effects/driving/kicks.h"

#include <cmath>

#include "kernels/double_double.h"
#include "src/physics/director.h"
#include "src/physics/vectors.h"
#include "src/random/needle_random.h"

namespace needlework {

// The product is exact, so that kicks late in a run are as far apart as the first ones.
Time Kicks::time(const Clock& clock, std::uint64_t n) const {
  const DoubleDouble since_start = two_prod(static_cast<double>(n), parameters_.every);
  // The clock takes no negative times: the lower part is taken off a time a little before.
  const double before = since_start.lo < 0 ? std::nextafter(since_start.hi, 0) : since_start.hi;
  return clock.add(clock.add({}, before), (since_start.hi - before) + since_start.lo);
}

Kicks::Change Kicks::change(Id id, std::uint64_t n, const Vec3d& director) const {
  NeedleRandom random(parameters_.seed, id.value, RandomFor::kick, n);
  const double root = std::sqrt(parameters_.every);
  Change out;
  out.velocity = vector_of(random.normal()) * (parameters_.translational * root);
  out.angular_velocity =
      project_out(vector_of(random.normal()) * (parameters_.rotational * root), director);
  return out;
}

std::vector<double> Kicks::parameters() const {
  const auto [low, high] = halves(parameters_.seed);
  return {parameters_.every, parameters_.translational, parameters_.rotational, low, high};
}

}  // namespace needlework
