// How far needles have moved and turned since an earlier state.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "needlework/state.h"
#include "src/box/box.h"
#include "src/observe/vector.h"

namespace needlework::observe {

/// Centres followed across the boundaries of the box; in a flow along x, beside it.
inline std::vector<Vector> unwrapped(const State& state) {
  const Box box = box_of(state);
  std::vector<Vector> out = state.position;
  for (std::size_t i = 0; i < state.image.size(); ++i) {
    const Vec3d way = box.image(state.image[i]).place;
    out[i] = {out[i][0] + way.x, out[i][1] + way.y, out[i][2] + way.z};
  }
  for (std::size_t i = 0; i < state.peculiar_x.size(); ++i) out[i][0] = state.peculiar_x[i];
  return out;
}

/// Means over needles; the observable `displacement` has the definitions.
struct Moved {
  double parallel = 0, perpendicular = 0, p1 = 0, p2 = 0;
};

/// Since needles were in other places and had other directors.
inline Moved moved(const std::vector<Vector>& position_then,
                   const std::vector<Vector>& orientation_then, const std::vector<Vector>& position,
                   const std::vector<Vector>& orientation) {
  Moved sum;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vector way = minus(position[i], position_then[i]);
    const double along = dot(way, orientation_then[i]);
    const double cosine = dot(orientation[i], orientation_then[i]);
    sum.parallel += along * along;
    sum.perpendicular += std::max(dot(way, way) - along * along, 0.0);
    sum.p1 += cosine;
    sum.p2 += second_legendre(cosine);
  }
  const double count = static_cast<double>(position.size());
  return {sum.parallel / count, sum.perpendicular / count, sum.p1 / count, sum.p2 / count};
}

}  // namespace needlework::observe
