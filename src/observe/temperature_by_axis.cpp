// Temperatures of the motion along and about each axis a of the box:
//
//   t_tr   <m v_a^2>
//   t_rot  (3/2) <I w_a^2>, <I w_a^2> of rough spheres
//
// The mean of the three is T_tr and T_rot, and in an isotropic gas all three are equal.
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class TemperatureByAxis : public Observable {
 public:
  explicit TemperatureByAxis(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override {
    return {
        {"t_tr",
         "Translational temperature along each axis, whose mean is t_tr",
         unit::energy,
         {{"3", 3}}},
        {"t_rot",
         "Rotational temperature about each axis, whose mean is t_rot",
         unit::energy,
         {{"3", 3}}},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    Vector v2{}, w2{};
    const Weights& weights = now.weights();
    for (std::size_t i = 0; i < now.state.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double v = now.state.velocity[i][axis], w = now.state.angular_velocity[i][axis];
        v2[axis] += weights.mass(i) * (v * v);
        w2[axis] += weights.inertia(i) * (w * w);
      }
    }
    const double count = static_cast<double>(now.state.size());
    for (const double sum : v2) row.put(gas_.mass * sum / count);
    for (const double sum : w2) row.put(3.0 / gas_.rotations * gas_.inertia * sum / count);
  }

 private:
  GasSetting gas_;
};

}  // namespace

ObservablePointer make_temperature_by_axis(const GasSetting& gas) {
  return std::make_unique<TemperatureByAxis>(gas);
}

}  // namespace needlework::observe
