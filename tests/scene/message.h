// What is wrong with a scene.
#pragma once

#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"

namespace needlework::test {

using Overrides = std::vector<std::string>;

/// The message of the InputError that a scene gives, or "no error".
inline std::string message(const std::string& text, const Overrides& overrides = {}) {
  try {
    parse_scene(text, "s.toml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace needlework::test
