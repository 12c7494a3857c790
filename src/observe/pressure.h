// The pressure of rods of finite width, the mean between two moments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "needlework/scene.h"
#include "needlework/totals.h"
#include "src/box/moving_edge.h"

namespace needlework::observe {

/// Sums since the start of a run from which it follows.
struct PressureSums {
  double time = 0;
  double t_tr_integral = 0;   ///< Simulation::t_tr_integral()
  double virial = 0;          ///< Simulation::virial()
  double normal_impulse = 0;  ///< of the hits on all walls
};
/// At the time of these sums.
PressureSums pressure_sums(double time, double t_tr_integral, double virial,
                           const std::vector<WallTotals>& walls);

class Pressure {
 public:
  explicit Pressure(const Scene& scene);

  /// [energy / L^3]; NaN where no time has passed, and where there is none.
  ///
  ///   without walls  p V dt = N (integral of T_tr) + (1/3) sum of r12 . dp over the collisions, N
  ///                  the needles that move; those with fixed ones count as if these moved apart
  ///                  as the box grows
  ///   between walls  p A dt = sum of J . n over the hits, A the area of all walls: layers along
  ///                  walls have another virial, and centres less room than the box
  ///
  /// With gravity along an axis with walls there is none, as it depends on the height.
  /// Areas that walls with a velocity change are means between the two times.
  double between(const PressureSums& from, const PressureSums& to) const;
  /// Which of these it is, in words.
  const char* meaning() const;

 private:
  enum class Kind : std::uint8_t { virial, walls, none };

  Kind kind_;
  double mean_area(double from, double until) const;

  double count_, volume_, area_ = 0;
  std::optional<MovingEdges> moving_edges_;
  std::vector<std::size_t> axes_;  ///< of each wall
};

}  // namespace needlework::observe
