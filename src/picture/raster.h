// A picture of pixels, into which lines are drawn without steps.
#pragma once

#include <cstddef>
#include <vector>

#include "src/picture/colours.h"
#include "src/picture/drawing.h"

namespace needlework::picture {

class Raster {
 public:
  Raster(int width, int height, Colour ground);

  /// Draws over what is there. Parts outside of the picture are left out.
  void draw(const Stroke& stroke);

  /// Row after row from the top, three bytes a pixel.
  const std::vector<Colour>& pixels() const { return pixels_; }
  Colour at(int x, int y) const { return pixels_[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_, height_;
  Colour ground_;
  std::vector<Colour> pixels_;
};

static_assert(sizeof(Colour) == 3);

}  // namespace needlework::picture
