// Checks of the theory's arguments.
#include "src/theory/requirements.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace needlework::theory {

void require(bool holds, std::string_view name, double value, std::string_view expectation) {
  if (!holds)
    throw std::invalid_argument(fmt::format("{} = {}: expected {}", name, value, expectation));
}

void require_positive(std::string_view name, double value) {
  require(std::isfinite(value) && value > 0.0, name, value, "a finite number above 0");
}

void require_not_negative(std::string_view name, double value) {
  require(std::isfinite(value) && value >= 0.0, name, value, "a finite number, 0 or more");
}

void require_valid(const Gas& gas) {
  // Far beyond any mass distribution; farther out, squares and cubes of k overflow or underflow.
  require(gas.k >= 1e-12 && gas.k <= 1e12, "k", gas.k, "a number in [1e-12, 1e12]");
  require(gas.epsilon >= 0.0 && gas.epsilon <= 1.0, "epsilon", gas.epsilon, "a number in [0, 1]");
  require(gas.beta >= -1.0 && gas.beta <= 1.0, "beta", gas.beta, "a number in [-1, 1]");
}

void require_valid(Temperatures temperatures) {
  require_not_negative("t_tr", temperatures.t_tr);
  require_not_negative("t_rot", temperatures.t_rot);
  require_not_negative("energy", temperatures.energy());  // which may overflow
}

}  // namespace needlework::theory
