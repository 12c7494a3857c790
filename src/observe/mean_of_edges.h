// Means between two samples of what walls with a velocity change.
#pragma once

#include "src/box/moving_edge.h"

namespace needlework::observe {

/// Of a product of edges, such as a volume, from one time since the start of the scene to another.
template <class Product>
double mean_of_edges(const MovingEdges& edges, double from, double until, const Product& product) {
  if (!(until > from)) return product(edges.distances(until));
  const double before = from > 0 ? from * edges.mean(from, product) : 0;
  return (until * edges.mean(until, product) - before) / (until - from);
}

}  // namespace needlework::observe
