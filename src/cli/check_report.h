// What `needlework check` prints.
#pragma once

#include <string>

#include "src/runs/explanation.h"

namespace needlework::cli {

/// The object that `check --json` prints.
std::string json_of(const runs::Explanation& explanation);

/// Some lines for people.
std::string text_of(const runs::Explanation& explanation);

}  // namespace needlework::cli
