// JSON from elsewhere, of which deep values would end the program: they are copied and printed by
// recursion.
#pragma once

#include <string>
#include <utility>

#include "needlework/error.h"

namespace needlework::json {

/// Greatest depth that is read.
inline constexpr int most_levels = 100;

/// Parses a text or a stream. Throws InputError for deeper values, and what Json::parse() throws.
template <class Json, class Input>
Json parse_shallow(Input&& input) {
  const auto within_depth = [](int depth, typename Json::parse_event_t, const Json&) {
    if (depth > most_levels) {
      throw InputError("expected values in at most " + std::to_string(most_levels) + " levels");
    }
    return true;
  };
  return Json::parse(std::forward<Input>(input), within_depth);
}

}  // namespace needlework::json
