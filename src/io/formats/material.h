// What all needles of a file have in common, and the law of their collisions.
#pragma once

#include <optional>
#include <string>

namespace needlework::io {

/// One species of needles and its restitution. What a file does not say is absent.
struct Material {
  std::string name = "needles";
  std::optional<double> length;   ///< [L]
  std::optional<double> mass;     ///< [m]
  std::optional<double> k;        ///< m L^2 / (2 I) [1]
  std::optional<double> epsilon;  ///< normal restitution [1]
  std::optional<double> beta;     ///< tangential restitution [1]
};

/// Reads the material of an H5MD file: the numbers in /parameters that a Writer writes or else, of
/// the mass, those in the group of the needles. Throws IoError if the file cannot be read, and
/// InputError if a number cannot be used or if the needles have several masses.
Material read_material(const std::string& path);

/// Throws InputError if length, mass, k or epsilon is absent. `path` is the file that was read.
void require_complete(const Material& material, const std::string& path);

}  // namespace needlework::io
