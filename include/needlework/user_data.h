// Data of a user's own that a run carries in its checkpoints and its file, such as the state of a
// random number generator, or notes.
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace needlework {

/// One value, which replaces that of the same name before.
struct UserData {
  enum class Kind { bytes, json };

  Kind kind = Kind::bytes;
  std::string bytes;  ///< any, or JSON in UTF-8

  friend bool operator==(const UserData&, const UserData&) = default;
};

/// By name.
using UserDataByName = std::map<std::string, UserData>;

/// A name has at least 1 and at most so many bytes of printable UTF-8.
inline constexpr std::size_t longest_data_name = 64;
/// Most bytes of one value.
inline constexpr std::size_t longest_data = std::size_t{1} << 24;

/// Throws InputError, "data: ...", for a name or a value that a file could not hold, and for JSON
/// that is none.
void require_valid_data(const std::string& name, const UserData& data);

}  // namespace needlework
