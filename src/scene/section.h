// What a section of a scene consists of: its keys with their ranges, and the rules of how they go
// together. An effect has all of its own in one file of src/scene/sections.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "needlework/scene.h"
#include "src/scene/entry.h"

namespace needlework {

/// What of a scene somebody looks at. Each key and each rule belongs to one.
enum class Aspect : unsigned {
  species = 1 << 0,    ///< which species there are
  bodies = 1 << 1,     ///< what needles are; not known before a state is read that says it
  pairs = 1 << 2,      ///< whether [[pairs]] are of the species
  walls = 1 << 3,      ///< what bounds the needles
  effects = 1 << 4,    ///< how they move and collide, and how that is computed
  machine = 1 << 5,    ///< whether the engine can be made as asked for, on this machine
  output = 1 << 6,     ///< what the engine does not read: names, ends, output
  room = 1 << 7,       ///< whether the box has room for the needles
  start = 1 << 8,      ///< what an initial state is drawn from
  end = 1 << 9,        ///< whether a run that goes on until its end comes to one
  restored = 1 << 10,  ///< what holds for every scene that has been read from a text
  sizes = 1 << 11,     ///< what bodies are, also where the rows of a state say it
};

/// A set of aspects.
class Aspects {
 public:
  constexpr Aspects(Aspect one) : bits_(static_cast<unsigned>(one)) {}
  constexpr bool has(Aspect one) const { return (bits_ & static_cast<unsigned>(one)) != 0; }
  friend constexpr Aspects operator|(Aspects a, Aspects b) { return Aspects(a.bits_ | b.bits_); }

 private:
  constexpr explicit Aspects(unsigned bits) : bits_(bits) {}
  unsigned bits_;
};
constexpr Aspects operator|(Aspect a, Aspect b) { return Aspects(a) | Aspects(b); }

/// The numbers that a key accepts, or each of its components.
struct ValueRange {
  double least = std::numeric_limits<double>::lowest();
  double greatest = std::numeric_limits<double>::max();
  bool or_zero = false;  ///< besides those, 0

  constexpr bool holds(double x) const {  // false for NaN
    return (x >= least && x <= greatest) || (or_zero && x == 0);
  }
};

/// Whether a scene file has to give a key.
enum class Presence {
  optional,
  required,  ///< in each entry of a section [[...]], and in each table "KEY." that has another key
  to_draw,   ///< unless a state is given
};

/// A word that is not known, and the known one that is most similar, or empty.
struct UnknownWord {
  std::string word;
  std::string_view nearest;
};

/// One key of a scene file.
struct SceneKey {
  std::string_view key;
  Aspect aspect;
  ValueRange range;           ///< of numbers, besides what `expected` says of the type
  std::string_view expected;  ///< the requirement on the value, for messages
  /// Stores the value in the scene. Returns false, and leaves the scene unchanged, if the value
  /// does not meet the requirement. `range` is that of the key.
  bool (*store)(Scene& scene, const Value& value, const ValueRange& range);
  Presence presence = Presence::optional;
  /// What is wrong with a value that was refused, if more can be said than the requirement: the
  /// word in it that is not known.
  std::optional<UnknownWord> (*unknown_word)(const Value& value) = nullptr;
  /// A key that is required is not where one of these is: keys of another form of the same table.
  std::array<std::string_view, 2> unless = {};
  std::string_view section = {};  ///< empty for a key outside all sections; set by the schema

  bool read(Scene& scene, const Value& value) const { return store(scene, value, range); }
  /// For the message about a value that was refused: "expected ...".
  std::string expected_instead_of(const Value& value) const;
};

/// What is wrong with a scene: the message is "PLACE: REASON".
struct Violation {
  std::string key;     ///< "section.key", as Scene::places has it; empty: the scene as a whole
  std::string value;   ///< as messages quote it where the key has no place; empty: the key alone
  std::string reason;  ///< "expected ..."
  /// Keys that are at fault as much; the message names the one that was given last.
  std::vector<std::string> or_keys = {};
};

/// What a scene has to be besides having each value in its range.
struct SceneRule {
  Aspect aspect;
  /// May be asked of any scene of which the keys of the aspect are in their ranges.
  std::optional<Violation> (*violation)(const Scene& scene);
};

/// What an override does to the other key of two that exclude each other, in the file.
enum class Replaces { neither, first_the_second, each_the_other };

/// Two keys of which a scene file has one at most. "SECTION." stands for any key of a section.
struct Exclusion {
  std::string_view one, other;
  std::string_view expected;
  Replaces replaces = Replaces::neither;
};

/// The entries of a section that occurs several times, as [[NAME]].
struct Entries {
  std::size_t most = 0;  ///< 0: it occurs once, as [NAME]
  std::size_t (*count)(const Scene& scene) = nullptr;
  void (*append)(Scene& scene) = nullptr;
  void (*swap_with_last)(Scene& scene, std::size_t entry) = nullptr;
};

/// The entries that a member of Scene holds.
template <auto member>
constexpr Entries entries_in(std::size_t most) {
  return {.most = most,
          .count = [](const Scene& scene) { return (scene.*member).size(); },
          .append = [](Scene& scene) { (scene.*member).emplace_back(); },
          .swap_with_last =
              [](Scene& scene, std::size_t entry) {
                std::swap((scene.*member)[entry], (scene.*member).back());
              }};
}

struct SceneSection {
  std::string_view name;
  std::vector<SceneKey> keys;  ///< in the order of their documentation
  std::vector<SceneRule> rules = {};
  std::vector<Exclusion> exclusions = {};
  Entries entries = {};

  bool is_repeated() const { return entries.most > 0; }
};

/// A key "section.key" of an entry of a section that occurs again, as Scene::places has it.
std::string key_of_entry(std::string_view key, std::size_t entry);

/// ", did you mean NAME?", or nothing for no name.
std::string did_you_mean(std::string_view name);

/// A text in quotes, printable, as messages quote it.
std::string in_quotes(std::string_view text);

/// Largest frequency, acceleration and strength of kicks; the least is its inverse.
inline constexpr double largest_rate = 1e100;
/// Temperatures beyond which squares and products of physical quantities would exceed the range of
/// a double.
inline constexpr ValueRange temperatures{1e-200, 1e200};

/// The range with 0 besides.
constexpr ValueRange or_zero(ValueRange range) { return {range.least, range.greatest, true}; }

}  // namespace needlework
