// Colours of curves and of values, distinct for the colour-blind too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace needlework::picture {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

inline constexpr Colour ink{0x22, 0x22, 0x22};  ///< of text and of most lines

/// "#rrggbb".
std::string hex(Colour colour);

/// `share` of the first and the rest of the second.
Colour mixed(Colour first, Colour second, double share);

/// Whether dark lines are seen better on this colour than light ones.
bool is_light(Colour colour);

/// The colour of the curve of this number, of the palette of Okabe and Ito without its yellow,
/// which is lost on white. The numbers start again after the last colour.
Colour curve_colour(std::size_t number);

/// Colours at equal steps of a scale, from its low end.
using Gradient = std::span<const Colour>;
/// Viridis: dark blue to yellow, equally bright steps.
Gradient sequential_gradient();
/// Blue to red through white.
Gradient diverging_gradient();
/// The same for needles, which must be seen against a ground that is dark or light.
Gradient sequential_gradient(bool dark_ground);
Gradient diverging_gradient(bool dark_ground);

/// The colour at a share in [0, 1] of the scale; shares beyond it have the colour of its ends.
Colour colour_at(Gradient gradient, double share);

}  // namespace needlework::picture
