// Numbers as JSON has them.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace needlework::cli {

/// JSON has no NaN and no infinity; both become null.
inline nlohmann::ordered_json number(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}

}  // namespace needlework::cli
