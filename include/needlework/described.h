// How the numbers of a result are called. Every interface has them from such a list: JSON, pipe, C,
// Fortran, Python, series of files, summary and documents, so that a new number is written down
// once.
#pragma once

namespace needlework {

/// Units in words, as files have them.
namespace unit {
inline constexpr const char* none = "";
inline constexpr const char* time = "time";
inline constexpr const char* rate = "per time";
inline constexpr const char* length = "length";
inline constexpr const char* area = "length squared";
inline constexpr const char* wave_number = "radians per length";
inline constexpr const char* density = "needles per volume";
inline constexpr const char* speed = "length per time";
inline constexpr const char* angular_speed = "radians per time";
inline constexpr const char* energy = "energy";
inline constexpr const char* angle = "radians";
inline constexpr const char* pressure = "energy per volume";
inline constexpr const char* viscosity = "energy times time per volume";
inline constexpr const char* momentum = "mass times length per time";
inline constexpr const char* virial = "mass times length squared per time";
}  // namespace unit

/// A number of a result: its name in all interfaces, its unit, and a sentence without its full
/// stop.
struct Described {
  const char* name;
  const char* unit;
  const char* meaning;
};

}  // namespace needlework
