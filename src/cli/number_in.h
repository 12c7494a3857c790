// Numbers on the command line.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

namespace needlework::cli {

/// A number from `least` to `most`. CLI::Range lets nan pass.
inline CLI::Validator number_in(double least, double most) {
  const std::string expected = fmt::format("a number from {:g} to {:g}", least, most);
  return {[=](const std::string& text) -> std::string {
            double value = 0;
            const bool fits =
                CLI::detail::lexical_cast(text, value) && least <= value && value <= most;
            return fits ? "" : fmt::format("{}: expected {}", text, expected);
          },
          expected};
}

}  // namespace needlework::cli
