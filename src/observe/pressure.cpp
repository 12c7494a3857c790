#include "src/observe/pressure.h"

#include <array>
#include <limits>

#include "src/observe/mean_of_edges.h"
#include "src/scene/confinement.h"

namespace needlework::observe {

PressureSums pressure_sums(double time, double t_tr_integral, double virial,
                           const std::vector<WallTotals>& walls) {
  PressureSums out{.time = time, .t_tr_integral = t_tr_integral, .virial = virial};
  for (const WallTotals& wall : walls) out.normal_impulse += wall.normal_impulse;
  return out;
}

Pressure::Pressure(const Scene& scene)
    : kind_(scene.walls.empty() ? Kind::virial : Kind::walls),
      count_(static_cast<double>(scene.composition().count() - scene.composition().fixed())),
      moving_edges_(moving_edges_of(scene, scene.needles.box)) {
  const std::array<double, 3>& box = scene.needles.box;
  volume_ = box[0] * box[1] * box[2];
  for (const Scene::WallSide& side : scene.wall_sides()) {
    area_ += volume_ / box[side.axis];
    axes_.push_back(side.axis);
    if (scene.forces.gravity[side.axis] != 0) kind_ = Kind::none;
  }
}

double Pressure::between(const PressureSums& from, const PressureSums& to) const {
  const double time = to.time - from.time;
  if (!(time > 0) || kind_ == Kind::none) return std::numeric_limits<double>::quiet_NaN();
  if (kind_ == Kind::walls)
    return (to.normal_impulse - from.normal_impulse) / (mean_area(from.time, to.time) * time);
  const double kinetic = count_ * (to.t_tr_integral - from.t_tr_integral);
  return (kinetic + (to.virial - from.virial) / 3) / (volume_ * time);
}

double Pressure::mean_area(double from, double until) const {
  if (!moving_edges_) return area_;
  return mean_of_edges(*moving_edges_, from, until, [&](const Vector& edges) {
    double area = 0;
    for (const std::size_t axis : axes_) area += edges[(axis + 1) % 3] * edges[(axis + 2) % 3];
    return area;
  });
}

const char* Pressure::meaning() const {
  switch (kind_) {
    case Kind::virial:
      return "mean over the run, by the virial";
    case Kind::walls:
      return "mean over the run, on the walls";
    case Kind::none:
      break;
  }
  return "none: under gravity it depends on the height; walls have theirs";
}

}  // namespace needlework::observe
