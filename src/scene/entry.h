// Keys and values as a scene file gives them, whatever has read it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace needlework {

/// A value. monostate stands for dates and times, which no scene uses, and for tables that no
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

}  // namespace needlework
