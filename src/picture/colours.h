// Colours of values, distinct for the colour-blind too.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace needlework::picture {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// "#rrggbb".
std::string hex(Colour colour);

/// `share` of the first and the rest of the second.
Colour mixed(Colour first, Colour second, double share);

/// Colours at equal steps of a scale, from its low end.
using Gradient = std::span<const Colour>;
/// One hue to another, in equally bright steps, for needles that must be seen against a ground that
/// is dark or light.
Gradient sequential_gradient(bool dark_ground);
/// Blue to red, which meet in the middle.
Gradient diverging_gradient(bool dark_ground);

/// The colour at a share in [0, 1] of the scale; shares beyond it have the colour of its ends.
Colour colour_at(Gradient gradient, double share);

}  // namespace needlework::picture
