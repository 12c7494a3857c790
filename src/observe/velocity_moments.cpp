// Departure of the velocities from independent Gaussian ones, for which all of these are 0. Means
// are over all needles; velocities are not taken relative to a flow. Where masses and moments of
// inertia differ within a species, v stands for sqrt(m) v and w for sqrt(I) w.
//
//   cumulant_v         (3/5) <v^4> / <v^2>^2 - 1, the second Sonine coefficient
//   cumulant_w         (1/2) <w^4> / <w^2>^2 - 1, as w has two components; 3/5 of rough spheres
//   speeds             <v^2 w^2> / (<v^2> <w^2>) - 1
//   velocity_spin      <(v . w)^2> / <v^2 w^2> - 1/3, over 2/3: 1 if they are parallel, -1/2 normal
//   velocity_director  <(v . u)^2> / <v^2> - 1/3, over 2/3: 1 if needles fly along themselves,
//                      -1/2 if across
//
// The last two weight each needle by its squares, so that slow ones, of random directions, do not
// count.
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class VelocityMoments : public Observable {
 public:
  explicit VelocityMoments(const GasSetting& gas) : rotations_(gas.rotations) {}

  std::vector<SeriesField> fields() const override {
    return {
        {"cumulant_v", "Fourth cumulant of the velocities, (3/5) <v^4> / <v^2>^2 - 1", unit::none},
        {"cumulant_w",
         "Fourth cumulant of the angular velocities, (1/2) <w^4> / <w^2>^2 - 1; 3/5 in the place "
         "of 1/2 of rough spheres",
         unit::none},
        {"speeds", "Correlation of the two speeds, <v^2 w^2> / (<v^2> <w^2>) - 1", unit::none},
        {"velocity_spin",
         "Correlation of the directions of velocity and angular velocity, "
         "(3/2) <(v.w)^2> / <v^2 w^2> - 1/2",
         unit::none},
        {"velocity_director",
         "Correlation of the directions of velocity and needle, (3/2) <(v.u)^2> / <v^2> - 1/2",
         unit::none},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    double v2 = 0, v4 = 0, w2 = 0, w4 = 0, v2w2 = 0, along_spin = 0, along_director = 0;
    const Weights& weights = now.weights();
    for (std::size_t i = 0; i < now.state.size(); ++i) {
      const Vector& v = now.state.velocity[i];
      const Vector& w = now.state.angular_velocity[i];
      const double mass = weights.mass(i), inertia = weights.inertia(i);
      const double vv = mass * dot(v, v), ww = inertia * dot(w, w);
      const double vw = dot(v, w), vu = dot(v, now.state.orientation[i]);
      v2 += vv;
      v4 += vv * vv;
      w2 += ww;
      w4 += ww * ww;
      v2w2 += vv * ww;
      along_spin += mass * inertia * (vw * vw);
      along_director += mass * (vu * vu);
    }
    const double count = static_cast<double>(now.state.size());
    row.put(0.6 * (v4 * count / (v2 * v2)) - 1);
    // <x^2>^2 / <x^4> of a Gaussian vector of so many components.
    const double of_spin = rotations_ == 3 ? 0.6 : 0.5;
    row.put(of_spin * (w4 * count / (w2 * w2)) - 1);
    row.put(v2w2 * count / (v2 * w2) - 1);
    row.put(1.5 * (along_spin / v2w2) - 0.5);
    row.put(1.5 * (along_director / v2) - 0.5);
  }

 private:
  int rotations_;
};

}  // namespace

ObservablePointer make_velocity_moments(const GasSetting& gas) {
  return std::make_unique<VelocityMoments>(gas);
}

}  // namespace needlework::observe
