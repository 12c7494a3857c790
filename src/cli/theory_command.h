// `needlework theory`: what kinetic theory predicts for a gas.
#pragma once

#include <string>
#include <vector>

namespace needlework::cli {

/// The flags as given. They stay text until the command runs, so that what is no number and what is
/// out of range get the same kind of message.
struct TheoryArguments {
  std::string epsilon, k;
  std::string beta = "-1";
  std::string t_rot0 = "1";
  std::vector<std::string> taus;
  bool json = false;
};

/// Prints the predictions on stdout and returns 0, or prints one line on stderr that names option,
/// value and expectation and returns 2.
int run(const TheoryArguments& arguments);

}  // namespace needlework::cli
