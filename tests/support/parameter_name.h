// Names of parameterised tests.
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <utility>

namespace needlework::test {

/// Such as "k6_beta_m0p5" for k = 6 and beta = -0.5: names of tests hold letters, digits and
/// underscores only.
inline std::string parameter_name(std::initializer_list<std::pair<const char*, double>> values) {
  std::string name;
  for (const auto& [key, value] : values) {
    name += fmt::format("{}{}{}{:g}", name.empty() ? "" : "_", key, value < 0 ? "_" : "", value);
  }
  for (char& c : name) c = c == '.' ? 'p' : c == '-' ? 'm' : c;
  return name;
}

}  // namespace needlework::test
