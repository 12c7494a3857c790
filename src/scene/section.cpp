#include "src/scene/section.h"

#include <fmt/format.h>

#include "src/scene/printable.h"

namespace needlework {

std::string SceneKey::expected_instead_of(const Value& value) const {
  const auto unknown = unknown_word ? unknown_word(value) : std::nullopt;
  if (!unknown) return fmt::format("expected {}", expected);
  return fmt::format("\"{}\": expected {}{}", printable(unknown->word, 60), expected,
                     did_you_mean(unknown->nearest));
}

std::string did_you_mean(std::string_view name) {
  return name.empty() ? "" : fmt::format(", did you mean {}?", name);
}

std::string key_of_entry(std::string_view key, std::size_t entry) {
  return entry == 0 ? std::string(key) : fmt::format("{}#{}", key, entry);
}

std::string in_quotes(std::string_view text) { return '"' + printable(text, 60) + '"'; }

}  // namespace needlework
