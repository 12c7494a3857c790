// Whether a measurement agrees with a number of the paper.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace needlework::reproduce {

enum class Verdict { agrees, differs, open };

/// "agrees", "differs" or "open".
std::string_view name_of(Verdict verdict);

/// What a source states: a number and how precisely it states it.
struct Stated {
  std::optional<double> number = {}, precision = {};
};

/// A number that was measured, with its standard error over independent runs.
struct Measured {
  double value = 0;
  double error = 0;                       ///< standard error; 0 for what is computed without chance
  std::optional<std::size_t> seeds = {};  ///< independent runs; none for what is computed
};

/// A measurement agrees with what is stated if they differ by at most three standard errors plus
/// the stated precision, and differs from it otherwise. It is open where this cannot be decided:
/// without a number or a precision, with fewer than three independent runs, with a value or an
/// error that is not finite, and with a standard error above the stated precision.
Verdict verdict_of(const Stated& stated, const Measured& measured);

}  // namespace needlework::reproduce
