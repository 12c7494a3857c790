// Words as lines, for pictures of pixels: a picture needs no font of the machine.
#pragma once

#include <string>
#include <vector>

#include "src/picture/drawing.h"

namespace needlework::picture {

/// The lines of small letters, digits and . , : / + - = ( ). Any other character is a box.
std::vector<Stroke> strokes_of(const Words& words);

/// How long the words are [pixels].
double length_of(const Words& words);

/// Whether all characters of a text have a shape of their own.
bool can_be_written(const std::string& text);

}  // namespace needlework::picture
