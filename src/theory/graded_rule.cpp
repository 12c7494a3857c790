// Quadrature on an interval that starts at zero, graded towards zero.
#include "src/theory/graded_rule.h"

#include <boost/math/quadrature/gauss.hpp>
#include <cassert>
#include <cmath>

namespace needlework::theory {

namespace {

/// Integrands like 1 / (1 + (x/a)^2) have their poles at distance pi/2 from the real axis of log x.
/// With 20 nodes on a panel of length 2, the error is then below 1e-20.
using PanelRule = boost::math::quadrature::gauss<double, 20>;
constexpr double longest_panel = 2.0;

/// Calls add(x, weight) for each Gauss node of the panel.
template <class Add>
void for_each_node(double begin, double end, Add add) {
  const double middle = 0.5 * (begin + end);
  const double half = 0.5 * (end - begin);
  for (std::size_t i = 0; i < PanelRule::abscissa().size(); ++i) {
    const double offset = half * PanelRule::abscissa()[i];
    const double weight = half * PanelRule::weights()[i];
    add(middle - offset, weight);
    add(middle + offset, weight);
  }
}

}  // namespace

std::vector<Node> graded_rule(double upper, double finest) {
  assert(0.0 < finest && finest < upper);
  std::vector<Node> nodes;
  for_each_node(0.0, finest, [&](double x, double weight) { nodes.push_back({x, weight}); });

  const double begin = std::log(finest);
  const double length = std::log(upper) - begin;
  const int panels = static_cast<int>(std::ceil(length / longest_panel));
  for (int panel = 0; panel < panels; ++panel) {
    for_each_node(begin + length * panel / panels, begin + length * (panel + 1) / panels,
                  [&](double log_x, double weight) {
                    const double x = std::exp(log_x);
                    nodes.push_back({x, x * weight});
                  });
  }
  return nodes;
}

}  // namespace needlework::theory
