// All sections of a scene file. A new effect adds its section here and to the list in
// src/scene/schema.cpp.
#pragma once

#include "src/scene/section.h"

namespace needlework {

SceneSection needles_section();
SceneSection species_section();
SceneSection initial_section();
SceneSection collisions_section();
SceneSection pairs_section();
SceneSection walls_section();
/// Adds what [[species]] says of bodies that differ.
void add_sizes(SceneSection& species);
/// Adds what [[species]] says of bodies that do not move.
void add_fixed(SceneSection& species);
SceneSection forces_section();
SceneSection shear_section();
SceneSection driving_section();
SceneSection engine_section();
SceneSection until_section();
SceneSection output_section();

/// What bodies a scene may have, for the two sections that describe them.
inline constexpr ValueRange range_of_k{1e-9, 1e9};
inline constexpr const char* expected_k = "a number > 0 (from 1e-9 to 1e9; 6 is a uniform rod)";
inline constexpr ValueRange lengths{1e-6, 1e6, true};
inline constexpr ValueRange masses{1e-100, 1e100};
inline constexpr const char* expected_diameter =
    "a diameter >= 0 (0 for thin needles, or from 1e-6 to 1e6)";
inline constexpr ValueRange counts_of_needles{0, static_cast<double>(most_needles)};
inline constexpr const char* expected_count = "a whole number in digits, from 0 to 4294967294";
inline constexpr const char* expected_temperature =
    "a temperature >= 0 (0, or from 1e-200 to 1e200)";
inline constexpr const char* expected_positive_temperature =
    "a temperature > 0 (from 1e-200 to 1e200)";
inline constexpr ValueRange restitutions{0, 1}, tangential_restitutions{-1, 1};
inline constexpr const char* expected_epsilon = "a number from 0 to 1";
inline constexpr const char* expected_beta = "a number from -1 (smooth) to 1 (perfectly rough)";

}  // namespace needlework
