// A scene's TOML, overrides included, flattened to a list of entries that know where they stand.
// Its implementation alone knows which TOML library is used.
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

/// A TOML value; monostate stands for dates, times and tables, which no scene needs.
struct Value {
  using Array = std::vector<Value>;
  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array> data;

  /// The value as a T, or null when it is of another type.
  template <typename T>
  const T* as() const {
    return std::get_if<T>(&data);
  }
};

/// Lines and columns count from 1, columns in code points; the end is one past the last column.
struct Region {
  std::size_t line = 0;
  std::size_t column = 0;
  std::size_t end_line = 0;
  std::size_t end_column = 0;
};

/// One key with its value, or the head of a table. A key outside all tables has no section.
struct Entry {
  std::string section;
  std::string key;
  Value value;
  Region region;              ///< of the value or the head; empty for a table without braces
  bool is_head = false;       ///< stands for [section] itself, without key and value
  bool is_repeated = false;   ///< of a section written [[section]], which may stand several times
  bool is_override = false;   ///< given by --set
  std::string override_text;  ///< the value as given there
  std::string named;          ///< Override::place
};

/// A key given from outside the file of a scene.
struct Override {
  std::string assignment;  ///< "section.key=value" or "key=value", the value in TOML
  std::string place;       ///< how messages name it; empty: "--set ASSIGNMENT"
};

/// The entries of a scene file in the order in which they stand there, then the overrides in the
/// order given; nothing is replaced yet. Keeps a view of `text` and of `name`.
class Document {
 public:
  /// Throws InputError for what is no TOML, is nested deeper than any scene needs, or is an
  /// override without "section.key=" or "key=".
  Document(std::string_view text, std::string_view name, std::span<const Override> overrides);

  const std::vector<Entry>& entries() const { return entries_; }

  /// How messages name an entry: "NAME: line N: section.key = VALUE", or "--set section.key=VALUE"
  /// for an override.
  std::string place(const Entry& entry) const;

  /// The error to throw for an entry: "PLACE: expected ...".
  InputError error(const Entry& entry, std::string_view expected) const;

  /// The error to throw for what is not there: "NAME: WHAT is missing: expected ...".
  InputError missing(std::string_view what, std::string_view expected) const;

 private:
  std::string source_of(const Region& region) const;

  std::string_view text_;
  std::string_view name_;
  std::vector<Entry> entries_;
};

}  // namespace needlework
