// Grids: the runs that make up a sweep, as a file in TOML names them.
//
//   scene = "cooling.toml"              base scene, a path relative to this file; without it, the
//                                       file has the sections of a scene itself
//   seeds = [1, 2, 5]                   or { first = 1, count = 16 }
//   out = "cooling-sweep"               folder for the results; `--out` comes first
//   [parameters]
//   "collisions.epsilon" = [0.9, 0.8]   a list: one point of the grid for each value
//   "needles.count" = 2000              no list: the value for all members
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/scene.h"
#include "src/scene_text/document.h"

namespace needlework::runs::sweep {

/// The most runs that a grid may have.
inline constexpr std::size_t most_members = 100000;

/// A key of the scene that is varied.
struct Parameter {
  std::string key;            ///< "section.key"
  std::vector<Value> values;  ///< all different
};

/// One run: a point of the grid with one of the seeds.
struct Member {
  std::string name;  ///< such as "epsilon=0.9,seed=3"; fit for a file's name, no two are the same
  std::size_t point = 0;
  std::uint64_t seed = 0;
  Scene scene;  ///< without an output file, for one thread
};

struct Grid {
  std::string name;                   ///< of the file, for messages
  std::string text;                   ///< as read
  std::string base;                   ///< text of the base scene
  std::string out;                    ///< folder, or "" if the file names none
  std::vector<Parameter> parameters;  ///< in the order of the file
  std::vector<std::uint64_t> seeds;
  std::vector<Member> members;  ///< the last parameter varies fastest but for the seeds

  /// Points of the grid, the product of the numbers of values.
  std::size_t points() const { return members.size() / seeds.size(); }
  /// The value that a parameter has at a point.
  const Value& value(std::size_t parameter, std::size_t point) const;
  /// What distinguishes a point, such as "epsilon=0.9,count=100"; empty if it is
  /// the only one.
  std::string name_of_point(std::size_t point) const;
};

/// Reads a grid and makes the scenes of all its members. Throws InputError, "FILE: line N: key =
/// VALUE: expected ...", for the first error, and IoError when a file cannot be read. What a
/// member's end depends on must not be the clock, so until.wall_s is an error.
Grid read_grid(const std::string& path);

/// Gives the text of a file. Throws IoError if there is none.
using ReadText = std::function<std::string(const std::string& path)>;
/// The same where the texts of grid and base scene are not files on disk.
Grid read_grid(const std::string& path, const ReadText& read_text);

/// The value in TOML, numbers with all their digits.
std::string toml_of(const Value& value);

}  // namespace needlework::runs::sweep
