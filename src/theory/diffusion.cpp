#include "needlework/diffusion.h"

#include <cmath>
#include <numbers>

#include "src/theory/contact_integrals.h"
#include "src/theory/requirements.h"

namespace needlework::theory {

// A collision changes v and w along its normal alone, in proportion to V_n, with which they are
// correlated as far as they take part in it: (3/2) velocity_decay is the rate of contacts times the
// mean of 1/(1 + mu), and angular_velocity_decay that times the mean of mu/(1 + mu), mu = k r^2.
Transport uncorrelated_transport(double density, double temperature, double k) {
  require_not_negative("density", density);
  require_positive("temperature", temperature);
  require_positive("k", k);
  const Shares shares =
      ContactIntegrals(k, /*tangential=*/false).sums({temperature, temperature}).normal;
  const double rate = density * 0.5 * std::sqrt(std::numbers::pi);
  Transport out;
  out.velocity_decay = rate * (2.0 / 3) * (shares.translation + shares.exchange);
  out.angular_velocity_decay = rate * (shares.exchange + shares.rotation);
  out.diffusion = temperature / out.velocity_decay;
  out.rotational_diffusion = 2 * k * temperature / out.angular_velocity_decay;
  return out;
}

}  // namespace needlework::theory
