#include "src/box/box.h"

namespace needlework {

Box::Along Box::wrap_from_outside(std::size_t axis, double x) const {
  const double edge = edges_[axis];
  double boxes = std::floor(x / edge);
  const auto place = [&] { return to_double(DoubleDouble(x) - two_prod(boxes, edge)); };
  double out = boxes == 0 ? x : place();
  if (out < 0) {  // x / edge has been rounded up
    boxes -= 1;
    out = place();
  }
  if (out >= edge) {  // so little below the border that rounding reaches it
    boxes += 1;
    out = 0;
  }
  return {out, boxes};
}

}  // namespace needlework
