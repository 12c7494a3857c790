#include "needlework/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <set>
#include <system_error>
#include <vector>

#include "needlework/error.h"
#include "src/scene/document.h"
#include "src/scene/printable.h"
#include "src/scene/schema.h"

namespace needlework {
namespace {

std::string full_name(const Entry& entry) {
  return entry.section.empty() ? entry.key : entry.section + "." + entry.key;
}

// Whether an override takes the place of an earlier entry: of the same key, or of the alternative
// that the file has chosen (see parse_scene).
bool replaces(const std::string& override_name, const Entry& entry) {
  if (entry.is_head) return false;
  const std::string name = full_name(entry);
  if (name == override_name) return true;
  if (entry.is_override) return false;
  if (override_name == "collisions.tc") return name == "collisions.tc_relative";
  if (override_name == "collisions.tc_relative") return name == "collisions.tc";
  if (override_name == "initial.file") return name == "initial.t_tr" || name == "initial.t_rot";
  return false;
}

std::vector<Entry> with_overrides_applied(const std::vector<Entry>& entries) {
  std::vector<Entry> result;
  for (const Entry& entry : entries) {
    if (entry.is_override)
      std::erase_if(result,
                    [name = full_name(entry)](const Entry& e) { return replaces(name, e); });
    result.push_back(entry);
  }
  return result;
}

// What to expect instead of a key that excludes one given before it; empty when there is none.
std::string_view conflict(const std::string& name, const std::set<std::string>& given) {
  const auto has = [&](const char* other) { return given.contains(other); };
  if ((name == "collisions.tc" && has("collisions.tc_relative")) ||
      (name == "collisions.tc_relative" && has("collisions.tc")))
    return "expected either tc or tc_relative, not both";
  if ((name == "initial.file" && (has("initial.t_tr") || has("initial.t_rot"))) ||
      ((name == "initial.t_tr" || name == "initial.t_rot") && has("initial.file")))
    return "expected either file or temperatures to draw, not both";
  return {};
}

void require_what_is_needed(const Scene& scene, const Document& document,
                            const std::set<std::string>& given) {
  for (const char* key : {"count", "box"}) {
    const std::string name = std::string("needles.") + key;
    if (!given.contains(name) && scene.initial.file.empty())
      throw document.missing(name,
                             fmt::format("expected {}", find_scene_key("needles", key)->expected));
  }
  const Scene::Until& until = scene.until;
  if (!until.time && !until.collisions_per_needle && !until.energy_ratio && !until.wall_s)
    throw document.missing("an end condition in [until]",
                           "expected one or more of time, collisions_per_needle, energy_ratio, "
                           "wall_s");
}

// The text as read, overrides appended as comments.
std::string annotated(std::string_view text, std::span<const Override> overrides) {
  std::string result(text);
  if (!overrides.empty() && !result.empty() && result.back() != '\n') result += '\n';
  for (const Override& o : overrides) result += "# --set " + printable(o.assignment) + "\n";
  return result;
}

}  // namespace

Scene parse_scene(std::string_view text, std::string_view name,
                  std::span<const std::string> overrides) {
  std::vector<Override> set;
  for (const std::string& assignment : overrides) set.push_back({assignment, {}});
  return parse_overridden_scene(text, name, set);
}

Scene parse_overridden_scene(std::string_view text, std::string_view name,
                             std::span<const Override> overrides) {
  if (text.size() > max_scene_bytes)
    throw InputError(fmt::format("{}: too large: expected a scene of at most {} bytes",
                                 printable(name), max_scene_bytes));
  const Document document(text, name, overrides);
  Scene scene;
  std::set<std::string> given;
  for (const Entry& entry : with_overrides_applied(document.entries())) {
    if (entry.is_head) {
      if (!is_scene_section(entry.section)) throw document.error(entry, expected_instead(entry));
      continue;
    }
    const SceneKey* key = find_scene_key(entry.section, entry.key);
    if (!key) throw document.error(entry, expected_instead(entry));
    if (!key->read(scene, entry.value))
      throw document.error(entry, fmt::format("expected {}", key->expected));
    if (const std::string_view reason = conflict(full_name(entry), given); !reason.empty())
      throw document.error(entry, reason);
    given.insert(full_name(entry));
    scene.places[full_name(entry)] = document.place(entry);
  }
  require_what_is_needed(scene, document, given);
  scene.text = annotated(text, overrides);
  return scene;
}

std::string read_scene_text(const std::string& path) {
  // One byte more than is allowed shows what is too long.
  constexpr std::size_t bytes = max_scene_bytes + 1;
  errno = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
      std::fopen(path.c_str(), "rb"), [](std::FILE* f) { return f ? std::fclose(f) : 0; });
  std::string text(file ? bytes : 0, '\0');
  if (file) text.resize(std::fread(text.data(), 1, bytes, file.get()));
  if (!file || std::ferror(file.get()))
    throw IoError(fmt::format("{}: cannot be read: {}", printable(path),
                              std::generic_category().message(errno)));
  return text;
}

Scene read_scene(const std::string& path, std::span<const std::string> overrides) {
  return parse_scene(read_scene_text(path), path, overrides);
}

}  // namespace needlework
