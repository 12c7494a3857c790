// A place in a picture.
#pragma once

namespace needlework::picture {

/// From the left and from the top, if nothing else is said [pixels].
struct Point {
  double x = 0, y = 0;
};

}  // namespace needlework::picture
