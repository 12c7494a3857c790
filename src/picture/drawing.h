// A picture of lines and words, as PNG or SVG.
#pragma once

#include <string>
#include <vector>

#include "src/picture/colours.h"
#include "src/picture/point.h"

namespace needlework::picture {

/// A line with round ends.
struct Stroke {
  Point from, to;
  double width = 1;  ///< [pixels]
  Colour colour;
  double halo = 0;  ///< width of an edge of the colour of the ground on each side [pixels]
};

/// A line of text.
struct Words {
  enum class Anchor { start, middle, end };
  std::string text;
  Point place;  ///< of this anchor, on the base line
  Anchor anchor = Anchor::start;
  double size = 13;  ///< a capital is 0.72 of it high [pixels]
  Colour colour;
};

/// Strokes hide those before them; words are above all strokes.
struct Drawing {
  int width = 1, height = 1;  ///< [pixels]
  Colour ground;
  std::vector<Stroke> strokes;
  std::vector<Words> words;
  std::string title, description;  ///< for those who cannot see the picture; not in a PNG
};

/// The drawing as the text of an SVG file.
std::string svg(const Drawing& drawing);

/// The drawing as the bytes of a PNG file of 8 bits for each of red, green and blue. Throws
/// std::runtime_error if libpng fails, for lack of memory say.
std::string png(const Drawing& drawing);

}  // namespace needlework::picture
