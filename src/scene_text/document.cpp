#include "src/scene_text/document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <optional>
#include <tuple>
#include <utility>

#include "src/scene/printable.h"
#include "src/scene/schema.h"
#include "src/scene_text/toml_guard.h"

namespace needlework {
namespace {

// Largest lengths of the parts of a message [bytes].
constexpr std::size_t name_limit = 1000;
constexpr std::size_t key_limit = 40;
constexpr std::size_t value_limit = 60;
constexpr std::size_t reason_limit = 200;

Value value_of(const toml::node& node) {
  if (const auto* boolean = node.as_boolean()) return {boolean->get()};
  if (const auto* integer = node.as_integer()) return {integer->get()};
  if (const auto* number = node.as_floating_point()) return {number->get()};
  if (const auto* string = node.as_string()) return {string->get()};
  if (const auto* array = node.as_array()) {
    Value::Array values;
    for (const toml::node& element : *array) values.push_back(value_of(element));
    return {std::move(values)};
  }
  return {};
}

Region region_of(const toml::node& node) {
  const toml::source_region& source = node.source();
  return {source.begin.line, source.begin.column, source.end.line, source.end.column};
}

Entry entry_of(std::string_view section, std::string_view key, const toml::node& node) {
  Entry entry;
  entry.section = section;
  entry.key = key;
  entry.value = value_of(node);
  entry.region = region_of(node);
  // The position of such a table is its first key, which cannot stand for its value.
  if (node.is_table() && !node.as_table()->is_inline())
    entry.region = {entry.region.line, entry.region.column, entry.region.line, entry.region.column};
  return entry;
}

Entry head_of(std::string_view section, const toml::node& node) {
  Entry entry;
  entry.section = section;
  entry.is_head = true;
  entry.region = region_of(node);
  return entry;
}

// Appends a key of a section, or the keys of a table that a section may hold, each as "KEY.INNER".
void append_key(std::string_view section, std::string_view key, const toml::node& node,
                std::vector<Entry>& entries) {
  const toml::table* table = node.as_table();
  if (!table || table->empty() || !is_scene_table(section, key)) {
    entries.push_back(entry_of(section, key, node));
    return;
  }
  for (const auto& [inner, value] : *table)
    entries.push_back(entry_of(section, fmt::format("{}.{}", key, inner.str()), value));
}

// Appends one [[section]] with its keys.
void append_repeated(std::string_view section, const toml::node& element, std::size_t number,
                     std::vector<Entry>& entries) {
  const std::size_t first = entries.size();
  entries.push_back(head_of(section, element));
  for (const auto& [key, value] : *element.as_table())
    append_key(section, key.str(), value, entries);
  for (std::size_t n = first; n < entries.size(); ++n) {
    entries[n].is_repeated = true;
    entries[n].number = number;
  }
}

std::vector<Entry> flattened(const toml::table& root) {
  std::vector<Entry> entries;
  for (const auto& [name, node] : root) {
    const toml::array* array = node.as_array();
    if (array && !array->empty() && array->is_homogeneous(toml::node_type::table)) {
      for (std::size_t n = 0; n < array->size(); ++n)
        append_repeated(name.str(), (*array)[n], n, entries);
      continue;
    }
    const toml::table* table = node.as_table();
    if (!table) {
      entries.push_back(entry_of("", name.str(), node));
      continue;
    }
    entries.push_back(head_of(name.str(), node));
    for (const auto& [key, value] : *table) append_key(name.str(), key.str(), value, entries);
  }
  const auto place = [](const Entry& e) { return std::tuple(e.region.line, e.region.column); };
  // Stable: the header of a table stays before a key at the same position, as in "until.time = 1".
  std::stable_sort(entries.begin(), entries.end(),
                   [&](const Entry& a, const Entry& b) { return place(a) < place(b); });
  return entries;
}

// The TOML library's reason, without the words with which every message begins.
std::string reason(std::string_view description) {
  constexpr std::string_view prefix = "Error while parsing ";
  std::string text(description);
  if (text.starts_with(prefix)) text = "bad " + text.substr(prefix.size());
  if (text.ends_with("could not determine value type")) text += " (text needs quotes)";
  if (text.find("cannot redefine existing table") != std::string::npos) {
    text +=
        " (the keys of a section stand together: below [section], in braces, or as section.key)";
  }
  return printable(text, reason_limit);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t";
  const std::size_t begin = text.find_first_not_of(space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(space) - begin + 1);
}

std::string_view unquoted(std::string_view text) {
  const bool is_quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

bool is_bare_key(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), allowed);
}

// Parses TOML that is safe to parse. toml++ ends the process where memory fails it, so that there
// has to be enough before it begins: an element of an array takes two bytes of text and some
// hundred of memory.
toml::table parse(std::string_view text) {
  ::operator delete(::operator new(64 * text.size() + (std::size_t{1} << 16)));
  return toml::parse(text);
}

// Appends an override with its value, which is TOML if that is one value in TOML, otherwise a
// string. A table stands for its keys.
void append_override(Entry entry, std::vector<Entry>& entries) {
  const std::string toml = "value = " + entry.override_text;
  entry.value = {entry.override_text};
  try {
    const toml::table table = find_toml_hazard(toml) ? toml::table() : parse(toml);
    if (table.size() == 1) {
      std::vector<Entry> values;
      append_key(entry.section, entry.key, table.begin()->second, values);
      const bool is_table = table.begin()->second.is_table();
      for (Entry& each : values) {
        entry.key = std::move(each.key);
        entry.value = std::move(each.value);
        // Messages quote the value of this key, not the whole table.
        const Region& at = each.region;
        if (is_table && at.line == 1 && at.end_line == 1)
          entry.override_text = toml.substr(at.column - 1, at.end_column - at.column);
        entries.push_back(entry);
      }
      return;
    }
  } catch (const toml::parse_error&) {
  }
  entries.push_back(std::move(entry));
}

Entry parse_override(std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view path = trimmed(text.substr(0, equals));
  Entry entry = key_of_path(path);
  entry.is_override = true;
  const bool has_section = path.find('.') != path.npos;
  const std::string_view last = trimmed(path.substr(path.rfind('.') + 1));  // npos + 1 is 0
  const bool complete = equals != std::string_view::npos && is_bare_key(last) &&
                        (!has_section || is_bare_key(entry.section));
  if (!complete)
    throw InputError(
        fmt::format("--set {}: expected section.key=value", printable(text, value_limit)));
  entry.override_text = trimmed(text.substr(equals + 1));
  return entry;
}

}  // namespace

Entry key_of_path(std::string_view path) {
  Entry entry;
  const std::size_t dot = path.find('.'), last_dot = path.rfind('.');
  entry.key = trimmed(path.substr(last_dot + 1));  // npos + 1 is 0
  if (dot == path.npos) return entry;
  entry.section = trimmed(path.substr(0, dot));
  if (last_dot == dot) return entry;
  std::string_view item = trimmed(path.substr(dot + 1, last_dot - dot - 1));
  const std::size_t before_table = item.rfind('.');
  const std::string_view table = item.substr(before_table + 1);
  if (is_scene_table(entry.section, table)) {
    entry.key = fmt::format("{}.{}", table, entry.key);
    item = before_table == item.npos ? std::string_view() : item.substr(0, before_table);
  }
  entry.item = unquoted(item);
  return entry;
}

Document::Document(std::string_view text, std::string_view name,
                   std::span<const Override> overrides)
    : text_(text), name_(name) {
  const std::string file = printable(name, name_limit);
  if (const auto hazard = find_toml_hazard(text))
    throw InputError(fmt::format("{}: line {}: {}", file, hazard->line, hazard->reason));
  try {
    entries_ = flattened(parse(text));
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}: line {}: {}", file, error.source().begin.line,
                                 reason(error.description())));
  }
  for (const Override& given : overrides) {
    Entry entry = parse_override(given.assignment);
    entry.named = given.place;
    append_override(std::move(entry), entries_);
  }
}

std::string Document::place(const Entry& entry) const {
  if (!entry.named.empty()) return entry.named;
  std::string key = printable(entry.section, key_limit);
  if (!entry.item.empty()) key += "." + printable(entry.item, key_limit);
  if (!entry.is_head) key += (key.empty() ? "" : ".") + printable(entry.key, key_limit);
  if (entry.is_override)
    return fmt::format("--set {}={}", key, printable(entry.override_text, value_limit));
  const std::string line =
      fmt::format("{}: line {}: ", printable(name_, name_limit), entry.region.line);
  if (entry.is_head) return line + (entry.is_repeated ? "[[" + key + "]]" : "[" + key + "]");
  const std::string source = source_of(entry.region);
  const std::string value = source.empty() ? "{...}" : printable(source, value_limit);
  return fmt::format("{}{} = {}", line, key, value);
}

InputError Document::error(const Entry& entry, std::string_view expected) const {
  return InputError(fmt::format("{}: {}", place(entry), expected));
}

InputError Document::missing(std::string_view what, std::string_view expected) const {
  return InputError(
      fmt::format("{}: {} is missing: {}", printable(name_, name_limit), what, expected));
}

// The text of a region. Columns are code points, and a byte order mark does not count as one.
std::string Document::source_of(const Region& region) const {
  const auto offset = [&](std::size_t line, std::size_t column) {
    std::size_t at = text_.starts_with("\xef\xbb\xbf") ? 3 : 0;
    for (std::size_t l = 1; l < line && at < text_.size(); ++l)
      at = std::min(text_.find('\n', at), text_.size() - 1) + 1;
    const auto continues = [&](std::size_t i) {
      return i < text_.size() && (static_cast<unsigned char>(text_[i]) & 0xc0u) == 0x80u;
    };
    for (std::size_t c = 1; c < column && at < text_.size(); ++c) {
      ++at;
      while (continues(at)) ++at;
    }
    return at;
  };
  const std::size_t begin = offset(region.line, region.column);
  const std::size_t end = std::max(begin, offset(region.end_line, region.end_column));
  return std::string(text_.substr(begin, end - begin));
}

}  // namespace needlework
