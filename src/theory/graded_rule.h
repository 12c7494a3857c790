// Quadrature on an interval that starts at zero, for integrands that are smooth on a logarithmic
// scale: their features may lie at any fraction of the interval, however small.
#pragma once

#include <vector>

namespace needlework::theory {

/// One node of a quadrature rule: where to evaluate, and how much the value counts.
struct Node {
  double x;
  double weight;
};

/// Gauss-Legendre nodes for an integral from 0 to `upper`, packed evenly in log x from `finest` to
/// `upper`, so that a feature of width x around x is resolved to rounding; below `finest` (where
/// the integrand is taken to be smooth, or its share negligible) they are spread evenly in x. Needs
/// 0 < finest < upper.
std::vector<Node> graded_rule(double upper, double finest);

}  // namespace needlework::theory
