// `needlework theory`: what kinetic theory predicts for a gas.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace needlework::cli {

/// The options as given. Numbers stay text until the command runs, so that what is no number and
/// what is out of range get the same kind of message.
struct TheoryArguments {
  std::string scene;  ///< path, empty for none
  std::vector<std::string> overrides;
  std::optional<std::string> epsilon, k, q, beta, t_rot0, density;
  std::vector<std::string> taus, times;
  std::string boltzmann;  ///< "single", "encounters", or empty for kinetic theory
  std::optional<std::string> needles, seed, tc;  ///< with boltzmann
  bool json = false;
};

/// Prints the predictions on stdout and returns 0, or prints one line on stderr that names option,
/// value and expectation and returns 2. Throws InputError and IoError for a scene.
int run(const TheoryArguments& arguments);

}  // namespace needlework::cli
