// Quadrature on an interval that starts at zero, for integrands that are smooth on a logarithmic
// scale. Their features may lie at any fraction of the interval, however small.
#pragma once

#include <vector>

namespace needlework::theory {

/// One node of a quadrature rule: the position and the weight.
struct Node {
  double x;
  double weight;
};

/// Gauss-Legendre nodes for an integral from 0 to `upper`. They are evenly dense in log x from
/// `finest` to `upper`, so that a feature of width x around x is resolved to rounding. Below
/// `finest`, where the integrand must be smooth or negligible, they are evenly dense in x. Needs 0
/// < finest < upper.
std::vector<Node> graded_rule(double upper, double finest);

}  // namespace needlework::theory
