// Profiles along axes with walls: the needles whose centres are in each slab across such an axis e
// (src/observe/wall_slabs.h), n of them in the volume A d, with directors u:
//
//   density       n / (A d)
//   flow          <v . e>, by mass
//   t_tr, t_rot   <m v^2> / 3, <I w^2> / 2
//   t_normal      <m (v . e)^2>
//   velocity      <v>, by mass
//   t_tr_beside_flow  sum of m (v - <v>)^2 / (3 (n - 1)), as n needles have their own mean
//   p2            <(3 (u . e)^2 - 1) / 2>
//   cos2          <(u . e)^2>, 1/3 for random directors; no value for spheres, which have none
//   order_tensor  <(3 u u - 1) / 2>, whose component along e twice is p2
//   outside       number of needles in no slab
//
// Temperatures are those of the whole motion, as /series/t_tr is, so that means over slabs,
// weighted by the density, are those of the gas.
#include <algorithm>
#include <limits>

#include "src/observe/order_tensor.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

// Sums over the needles in one slab.
struct SlabSums {
  std::array<double, 3> momentum{};
  double count = 0, mass = 0, v_normal = 0, v2 = 0, v2_normal = 0, w2 = 0, p2 = 0, cos2 = 0;
  OrderTensor order;
};

class WallProfiles : public Observable {
 public:
  explicit WallProfiles(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override {
    constexpr auto constant = SeriesField::Kind::constant;
    const std::vector<Slabs>& slabs = gas_.wall_slabs;
    const std::size_t count = slabs.empty() ? 0 : slabs.front().count;
    const std::vector<SeriesField::Extent> axes{{"walled axes", slabs.size()}};
    auto each = axes;
    each.push_back({"slabs", count});
    auto vectors = each;
    vectors.push_back({"3", 3});
    auto tensors = each;
    tensors.insert(tensors.end(), {{"3", 3}, {"3", 3}});
    std::vector<double> axis, thickness, middles;
    for (const Slabs& of : slabs) {
      axis.push_back(static_cast<double>(of.axis));
      thickness.push_back(of.thickness);
      for (std::size_t n = 0; n < count; ++n) middles.push_back(of.middle(n));
    }
    return {
        {"density",
         "Number of needles in each slab across each axis with walls, divided by its "
         "volume",
         unit::density, each},
        {"flow", "Mean velocity along the axis in each slab", unit::speed, each},
        {"t_tr",
         "Translational temperature in each slab, two thirds of the mean energy of "
         "translation",
         unit::energy, each},
        {"t_rot", "Rotational temperature in each slab", unit::energy, each},
        {"t_normal", "Temperature of the motion along the axis in each slab, twice its mean energy",
         unit::energy, each},
        {"velocity", "Mean velocity in each slab", unit::speed, vectors},
        {"t_tr_beside_flow",
         "Translational temperature of the motion in each slab beside its mean velocity; NaN of "
         "one needle",
         unit::energy, each},
        {"p2", "Mean of (3 cos^2 - 1) / 2 of the angle between orientation and axis in each slab",
         unit::none, each},
        {"cos2",
         "Mean square cosine of the angle between orientation and axis in each slab; NaN of "
         "spheres",
         unit::none, each},
        {"order_tensor", "Mean of (3 u u - 1) / 2 over the orientations u in each slab", unit::none,
         tensors},
        {"outside", "Number of needles in no slab across each axis", unit::none, axes,
         SeriesField::Kind::count},
        {"axis", "Number of each axis with walls: 0 x, 1 y, 2 z", unit::none, axes, constant, axis},
        {"position", "Middle of each slab along its axis", unit::length, each, constant, middles},
        {"thickness", "Thickness of the slabs across each axis", unit::length, axes, constant,
         thickness},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    std::vector<std::vector<SlabSums>> axes;
    std::vector<double> outside;
    for (const Slabs& slabs : gas_.wall_slabs) {
      axes.push_back(sums_of(slabs, now.state, now.weights()));
      double inside = 0;
      for (const SlabSums& slab : axes.back()) inside += slab.count;
      outside.push_back(static_cast<double>(now.state.size()) - inside);
    }
    const auto put = [&](auto value) {
      for (std::size_t n = 0; n < axes.size(); ++n)
        for (const SlabSums& slab : axes[n]) row.put(value(slab, gas_.wall_slabs[n]));
    };
    // NaN without needles.
    const auto put_mean = [&](double SlabSums::*sum, double factor) {
      put([&](const SlabSums& slab, const Slabs&) { return factor * (slab.*sum / slab.count); });
    };
    put([&](const SlabSums& slab, const Slabs& slabs) {
      return slab.count / (now.volume() / now.edges()[slabs.axis] * slabs.thickness);
    });
    put([](const SlabSums& slab, const Slabs&) { return slab.v_normal / slab.mass; });
    put_mean(&SlabSums::v2, gas_.mass / 3);
    put_mean(&SlabSums::w2, gas_.t_rot(1));
    put_mean(&SlabSums::v2_normal, gas_.mass);
    for (const std::vector<SlabSums>& slabs : axes) {
      for (const SlabSums& slab : slabs)
        for (const double momentum : slab.momentum) row.put(momentum / slab.mass);
    }
    put([&](const SlabSums& slab, const Slabs&) {
      const double of_flow = dot(slab.momentum, slab.momentum) / slab.mass;
      return slab.count > 1 ? gas_.mass / 3 * ((slab.v2 - of_flow) / (slab.count - 1))
                            : std::numeric_limits<double>::quiet_NaN();
    });
    put_mean(&SlabSums::p2, 1);
    const bool has_axes = !gas_.composition.are_spheres();
    put_mean(&SlabSums::cos2, has_axes ? 1 : std::numeric_limits<double>::quiet_NaN());
    for (const std::vector<SlabSums>& slabs : axes)
      for (const SlabSums& slab : slabs) slab.order.put(row);
    row.put_all(outside);
  }

 private:
  static std::vector<SlabSums> sums_of(const Slabs& slabs, const State& state,
                                       const Weights& weights) {
    std::vector<SlabSums> out(slabs.count);
    for (std::size_t i = 0; i < state.size(); ++i) {
      const auto slab = slabs.of(state.position[i][slabs.axis]);
      if (!slab) continue;
      SlabSums& sums = out[*slab];
      const Vector &v = state.velocity[i], &w = state.angular_velocity[i];
      const double normal = v[slabs.axis];
      const double mass = weights.mass(i);
      ++sums.count;
      sums.mass += mass;
      sums.v_normal += mass * normal;
      for (std::size_t n = 0; n < 3; ++n) sums.momentum[n] += mass * v[n];
      sums.v2 += mass * dot(v, v);
      sums.v2_normal += mass * (normal * normal);
      sums.w2 += weights.inertia(i) * dot(w, w);
      const Vector& u = state.orientation[i];
      sums.p2 += second_legendre(u[slabs.axis]);
      sums.cos2 += u[slabs.axis] * u[slabs.axis];
      sums.order.add(u);
    }
    return out;
  }

  GasSetting gas_;
};

}  // namespace

ObservablePointer make_wall_profiles(const GasSetting& gas) {
  return std::make_unique<WallProfiles>(gas);
}

}  // namespace needlework::observe
