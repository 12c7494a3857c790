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

Wrapped Box::wrap_in_rows(const Vector& centre) const {
  const Along y = wrap_along(1, centre[1]), z = wrap_along(2, centre[2]);
  if (y.boxes == 0) {
    const Along x = wrap_along(0, centre[0]);
    return {{x.place, y.place, z.place}, {x.boxes, 0, z.boxes}};
  }
  // With one rounding, however many boxes it crosses.
  const DoubleDouble beside = DoubleDouble(centre[0]) - above_.offset * DoubleDouble(y.boxes);
  double boxes = std::floor(beside.hi / edges_[0]);
  const auto place = [&] { return to_double(beside - two_prod(boxes, edges_[0])); };
  double x = place();
  if (x < 0) {
    boxes -= 1;
    x = place();
  }
  if (x >= edges_[0]) {
    boxes += 1;
    x = std::max(place(), 0.0);
  }
  return {{x, y.place, z.place}, {boxes_ever(boxes, y.boxes), y.boxes, z.boxes}};
}

}  // namespace needlework
