// The TOML of a scene, overrides included, as a flat list of entries with their positions. Only
// the implementation of this header uses the TOML library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "needlework/error.h"

namespace needlework {

/// A TOML value. monostate stands for dates and times, which no scene uses, and for tables that no
/// section may hold.
struct Value {
  using Array = std::vector<Value>;
  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array> data;

  /// The value as a T, or null if it has another type.
  template <typename T>
  const T* as() const {
    return std::get_if<T>(&data);
  }
};

/// A part of the text. Lines and columns count from 1, columns in code points; the end is one past
/// the last column.
struct Region {
  std::size_t line = 0;
  std::size_t column = 0;
  std::size_t end_line = 0;
  std::size_t end_column = 0;
};

/// One key with its value, or the header of a table. A key outside all tables has no section; one
/// of a table that its section holds is "table.key".
struct Entry {
  std::string section;
  std::string item;  ///< of an override "section.item.key": which [[section]] it is for
  std::string key;
  Value value;
  Region region;              ///< of the value or the header; empty for a table without braces
  bool is_head = false;       ///< whether it is the header [section], without key and value
  bool is_repeated = false;   ///< whether the section is written [[section]], which may occur
                              ///< several times
  std::size_t number = 0;     ///< of that occurrence, from 0
  bool is_override = false;   ///< given by --set
  std::string override_text;  ///< the value as given in the override
  std::string named;          ///< Override::place
};

/// The section, the item and the key of "section.key", "section.item.key" or "key". The last part
/// may be "table.key", of a table that the section may hold.
Entry key_of_path(std::string_view path);

/// A key that is given outside the scene file.
struct Override {
  std::string assignment;  ///< "section.key=value", "section.item.key=value" or "key=value", the
                           ///< value in TOML; a key may be "table.key", and a value a table
  std::string place;       ///< how messages name it; if empty, "--set ASSIGNMENT"
};

/// The entries of a scene file in the order of the file, then the overrides in the order given;
/// nothing is replaced yet. Keeps references to `text` and `name`.
class Document {
 public:
  /// Throws InputError for text that is not TOML, for text nested deeper than any scene needs, and
  /// for an override without "section.key=" or "key=".
  Document(std::string_view text, std::string_view name, std::span<const Override> overrides);

  const std::vector<Entry>& entries() const { return entries_; }

  /// How messages name an entry: "NAME: line N: section.key = VALUE", or "--set section.key=VALUE"
  /// for an override.
  std::string place(const Entry& entry) const;

  /// The error to throw for an entry: "PLACE: expected ...".
  InputError error(const Entry& entry, std::string_view expected) const;

  /// The error to throw for a missing key or section: "NAME: WHAT is missing: expected ...".
  InputError missing(std::string_view what, std::string_view expected) const;

 private:
  std::string source_of(const Region& region) const;

  std::string_view text_;
  std::string_view name_;
  std::vector<Entry> entries_;
};

}  // namespace needlework
