// The TOML of a scene, overrides included, as a flat list of entries with their positions. Only
// the implementation of this header uses the TOML library.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/error.h"
#include "src/scene/entry.h"

namespace needlework {

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
