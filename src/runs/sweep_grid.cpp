#include "src/runs/sweep_grid.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/scene/check.h"
#include "src/scene/printable.h"
#include "src/scene/schema.h"
#include "src/scene/suggest.h"
#include "src/scene_text/overridden_scene.h"

namespace needlework::runs::sweep {
namespace {

constexpr std::string_view own_keys[] = {"scene", "seeds", "out", "parameters"};

/// A parameter as the file has it: varied, or one value for all.
struct Setting {
  Parameter parameter;
  bool varied = false;
  std::size_t line = 0;
};

std::string_view after_dot(std::string_view key) { return key.substr(key.find('.') + 1); }

// With what is added to it, the 255 bytes that file systems take.
constexpr std::size_t longest_name = 240;

// Fit for the name of a file in any shell.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool fit = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                     c == '.' || c == '+' || c == '-' || c == '_';
    if (fit || (!result.empty() && result.back() != '-')) result += fit ? c : '-';
  }
  while (result.ends_with('-')) result.pop_back();
  return result;
}

bool belongs_to_grid(const Entry& entry) {
  const std::string& name = entry.section.empty() ? entry.key : entry.section;
  return std::find(std::begin(own_keys), std::end(own_keys), name) != std::end(own_keys);
}

// Reads the file step by step; every step throws the first error it finds.
class Reader {
 public:
  Reader(const std::string& path, const ReadText& read_text)
      : name_(path), read_text_(read_text), text_(read_text(path)), document_(text_, name_, {}) {}

  Grid read();

 private:
  void require_known_words() const;
  const Entry* find(std::string_view key) const;
  std::string text_value(const Entry& entry, std::string_view expected) const;
  void read_base(const Entry* scene);
  std::string without_own_lines() const;
  std::vector<std::uint64_t> read_seeds() const;
  std::vector<std::uint64_t> read_seed_range() const;
  std::vector<Setting> read_settings() const;
  Setting read_setting(const Entry& entry) const;
  std::string place(const Setting& setting, const Value& value) const;
  void make_members();
  Member make_member(std::size_t point, std::uint64_t seed) const;

  std::string name_;
  const ReadText& read_text_;
  std::string text_;
  Document document_;
  Grid grid_;
  std::string base_name_;
  std::vector<Setting> settings_;
};

Grid Reader::read() {
  require_known_words();
  grid_.name = name_;
  grid_.text = text_;
  if (const Entry* out = find("out")) grid_.out = text_value(*out, "the path of a folder");
  read_base(find("scene"));
  grid_.seeds = read_seeds();
  settings_ = read_settings();
  for (const Setting& setting : settings_) {
    if (setting.varied) grid_.parameters.push_back(setting.parameter);
  }
  make_members();
  return std::move(grid_);
}

// Keys of the scene's sections are left to those who read scenes.
void Reader::require_known_words() const {
  std::vector<std::string_view> words(std::begin(own_keys), std::end(own_keys));
  const bool has_scene = find("scene") != nullptr;
  if (!has_scene) {
    words.push_back("title");
    words.insert(words.end(), scene_sections().begin(), scene_sections().end());
  }
  for (const Entry& entry : document_.entries()) {
    const std::string& word = entry.section.empty() ? entry.key : entry.section;
    if (std::find(words.begin(), words.end(), word) != words.end()) continue;
    if (has_scene && (is_scene_section(word) || word == "title")) {
      throw document_.error(entry,
                            "expected none beside scene = ..., but \"section.key\" = VALUE in "
                            "[parameters]");
    }
    const std::string_view nearest = nearest_word(word, words);
    throw document_.error(
        entry, fmt::format("expected one of {}{}", fmt::join(words, ", "),
                           nearest.empty() ? "" : fmt::format(", did you mean {}?", nearest)));
  }
}

// A key outside all tables.
const Entry* Reader::find(std::string_view key) const {
  const auto& entries = document_.entries();
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) {
    return !entry.is_head && entry.section.empty() && entry.key == key;
  });
  return found == entries.end() ? nullptr : &*found;
}

std::string Reader::text_value(const Entry& entry, std::string_view expected) const {
  const auto* text = entry.value.as<std::string>();
  if (!text || text->empty() || !is_printable(*text)) {
    throw document_.error(entry, fmt::format("expected {}", expected));
  }
  return *text;
}

void Reader::read_base(const Entry* scene) {
  if (!scene) {
    base_name_ = name_;
    grid_.base = without_own_lines();
    return;
  }
  const std::filesystem::path file = text_value(*scene, "the path of a scene");
  base_name_ = (std::filesystem::path(name_).parent_path() / file).string();
  try {
    grid_.base = read_text_(base_name_);
  } catch (const IoError& error) {
    throw IoError(fmt::format("{}: {}", document_.place(*scene), error.what()));
  }
}

// The file's own sections of a scene, on their own lines: what belongs to the grid is left blank.
std::string Reader::without_own_lines() const {
  std::vector<std::string> lines(1);
  for (const char c : text_) {
    lines.back() += c;
    if (c == '\n') lines.emplace_back();
  }
  for (const Entry& entry : document_.entries()) {
    if (!belongs_to_grid(entry)) continue;
    const std::size_t last = std::max(entry.region.line, entry.region.end_line);
    for (std::size_t line = entry.region.line; line <= last && line <= lines.size(); ++line) {
      if (line >= 1) lines[line - 1].assign(1, '\n');
    }
  }
  return fmt::format("{}", fmt::join(lines, ""));
}

std::vector<std::uint64_t> Reader::read_seeds() const {
  const Entry* entry = find("seeds");
  if (!entry) return read_seed_range();
  const SceneKey& key = *find_scene_key("needles", "seed");
  const auto* list = entry->value.as<Value::Array>();
  std::vector<std::uint64_t> seeds;
  for (const Value& value : list ? *list : Value::Array()) {
    Scene scene;
    if (!key.read(scene, value)) {
      throw document_.error(*entry, fmt::format("{}: expected {}", toml_of(value), key.expected));
    }
    seeds.push_back(scene.needles.seed);
  }
  if (seeds.empty() || seeds.size() > most_members ||
      std::set(seeds.begin(), seeds.end()).size() != seeds.size()) {
    throw document_.error(*entry, fmt::format("expected a list of 1 to {} different seeds, or "
                                              "{{first = SEED, count = N}}",
                                              most_members));
  }
  return seeds;
}

std::vector<std::uint64_t> Reader::read_seed_range() const {
  std::optional<std::uint64_t> first, count;
  const Entry* head = nullptr;
  for (const Entry& entry : document_.entries()) {
    if (entry.section != "seeds") continue;
    if (entry.is_head) {
      head = &entry;
      continue;
    }
    const auto* number = entry.value.as<std::int64_t>();
    if (entry.key == "first" && number && *number >= 0) {
      first = *number;
    } else if (entry.key == "count" && number && *number >= 1 &&
               *number <= static_cast<std::int64_t>(most_members)) {
      count = *number;
    } else if (entry.key == "first" || entry.key == "count") {
      throw document_.error(entry,
                            entry.key == "first"
                                ? "expected a seed, a whole number from 0"
                                : fmt::format("expected a number from 1 to {}", most_members));
    } else {
      throw document_.error(entry, "expected one of first, count");
    }
  }
  if (!head) throw document_.missing("seeds", "expected a list, or {first = SEED, count = N}");
  if (!first || !count) throw document_.error(*head, "expected both first and count");
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t n = 0; n < *count; ++n) seeds.push_back(*first + n);
  const SceneKey& key = *find_scene_key("needles", "seed");
  if (!accepts(key, Value{static_cast<std::int64_t>(seeds.back())})) {
    throw document_.error(*head, fmt::format("expected smaller seeds, each {}", key.expected));
  }
  return seeds;
}

std::vector<Setting> Reader::read_settings() const {
  std::vector<Setting> settings;
  for (const Entry& entry : document_.entries()) {
    if (entry.section == "parameters" && !entry.is_head) settings.push_back(read_setting(entry));
    if (entry.section.empty() && entry.key == "parameters")
      throw document_.error(entry, "expected a section [parameters]");
  }
  return settings;
}

Setting Reader::read_setting(const Entry& entry) const {
  const std::size_t dot = entry.key.find('.');
  if (dot == std::string::npos) {
    throw document_.error(entry, "expected \"section.key\" = [VALUES], the name in quotes");
  }
  const Entry named = key_of_path(entry.key);
  const SceneKey* key = find_scene_key(named.section, named.key);
  if (!key) throw document_.error(entry, expected_instead(named));
  if (entry.key == "needles.seed") throw document_.error(entry, "expected seeds = [...] instead");
  if (entry.key == "output.file" || entry.key == "engine.threads") {
    throw document_.error(entry, "expected other keys: a sweep sets this one for each member");
  }

  Setting setting;
  setting.line = entry.region.line;
  const auto* list = entry.value.as<Value::Array>();
  setting.varied = list != nullptr;
  setting.parameter = {entry.key, list ? *list : Value::Array{entry.value}};
  if (setting.parameter.values.empty()) throw document_.error(entry, "expected some values");
  std::set<std::string> names;
  for (const Value& value : setting.parameter.values) {
    if (!accepts(*key, value)) {
      throw InputError(fmt::format("{}: expected {}", place(setting, value), key->expected));
    }
    if (!names.insert(plain(toml_of(value))).second) {
      throw InputError(
          fmt::format("{}: expected a value unlike those before", place(setting, value)));
    }
  }
  return setting;
}

std::string Reader::place(const Setting& setting, const Value& value) const {
  return fmt::format("{}: line {}: {} = {}", printable(name_), setting.line, setting.parameter.key,
                     printable(toml_of(value), 60));
}

void Reader::make_members() {
  std::size_t points = 1;
  for (const Parameter& parameter : grid_.parameters) {
    points *= parameter.values.size();
    if (points * grid_.seeds.size() > most_members) {
      throw InputError(
          fmt::format("{}: too many members: expected at most {}", printable(name_), most_members));
    }
  }
  for (std::size_t point = 0; point < points; ++point) {
    for (const std::uint64_t seed : grid_.seeds) {
      grid_.members.push_back(make_member(point, seed));
    }
  }
}

Member Reader::make_member(std::size_t point, std::uint64_t seed) const {
  std::vector<Override> overrides;
  std::size_t varied = 0;
  for (const Setting& setting : settings_) {
    const Value& value =
        setting.varied ? grid_.value(varied++, point) : setting.parameter.values.front();
    overrides.push_back(
        {fmt::format("{}={}", setting.parameter.key, toml_of(value)), place(setting, value)});
  }
  overrides.push_back({fmt::format("needles.seed={}", seed),
                       fmt::format("{}: seeds: needles.seed = {}", printable(name_), seed)});

  Member member;
  member.point = point;
  member.seed = seed;
  const std::string name = grid_.name_of_point(point);
  member.name = fmt::format("{}{}seed={}", name, name.empty() ? "" : ",", seed);
  if (member.name.size() > longest_name) {
    throw InputError(
        fmt::format("{}: member {}...: a name of {} bytes: expected at most {}, as it "
                    "names files",
                    printable(name_), member.name.substr(0, 60), member.name.size(), longest_name));
  }
  member.scene = parse_overridden_scene(grid_.base, base_name_, overrides);
  member.scene.output.file.clear();
  member.scene.engine.threads = 1;
  member.scene.engine.threads_by_size = false;
  member.scene.places.erase("engine.threads");
  const Scene& scene = member.scene;
  if (scene.until.wall_s) {
    throw InputError(
        place_of(scene, "until.wall_s", fmt::to_string(*scene.until.wall_s)) +
        ": expected no limit of wall time: what a sweep finds must not depend on the clock");
  }
  if (!scene.initial.file.empty() && grid_.seeds.size() > 1) {
    throw InputError(place_of(scene, "initial.file", scene.initial.file) +
                     ": expected a single seed: a state from a file does not depend on it");
  }
  return member;
}

}  // namespace

const Value& Grid::value(std::size_t parameter, std::size_t point) const {
  for (std::size_t later = parameters.size() - 1; later > parameter; --later) {
    point /= parameters[later].values.size();
  }
  const std::vector<Value>& values = parameters[parameter].values;
  return values[point % values.size()];
}

std::string Grid::name_of_point(std::size_t point) const {
  std::string name;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    name += fmt::format("{}{}={}", p ? "," : "", after_dot(parameters[p].key),
                        plain(toml_of(value(p, point))));
  }
  return name;
}

Grid read_grid(const std::string& path) { return read_grid(path, read_scene_text); }

Grid read_grid(const std::string& path, const ReadText& read_text) {
  return Reader(path, read_text).read();
}

std::string toml_of(const Value& value) {
  if (const auto* boolean = value.as<bool>()) return *boolean ? "true" : "false";
  if (const auto* integer = value.as<std::int64_t>()) return fmt::to_string(*integer);
  if (const auto* number = value.as<double>()) return fmt::to_string(*number);
  if (const auto* array = value.as<Value::Array>()) {
    std::vector<std::string> elements;
    for (const Value& element : *array) elements.push_back(toml_of(element));
    return fmt::format("[{}]", fmt::join(elements, ", "));
  }
  const auto* text = value.as<std::string>();
  if (!text) return "{...}";
  std::string quoted = "\"";
  for (const char c : *text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace needlework::runs::sweep
