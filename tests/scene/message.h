// What is wrong with a scene.
#pragma once

#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"

namespace needlework::test {

using Overrides = std::vector<std::string>;

/// The message of the InputError that an action gives, or "no error".
template <class Action>
std::string refusal(Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The same for a scene.
inline std::string message(const std::string& text, const Overrides& overrides = {}) {
  return refusal([&] { parse_scene(text, "s.toml", overrides); });
}

}  // namespace needlework::test
