// Pressure of rods between two samples, by pressure.h.
#include "src/observe/rod_sums.h"

#include <cmath>

#include "src/observe/pressure.h"

namespace needlework::observe {
namespace {

class RodSums : public Observable {
 public:
  explicit RodSums(const Scene& scene, const GasSetting& gas)
      : pressure_(scene), packing_(gas.composition.packing_fraction(gas.volume())) {}

  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    return {
        {"packing_fraction",
         "Share of the volume of the box that rods take up",
         unit::none,
         {},
         constant,
         {packing_}},
        {"virial",
         "Sum of r12 . dp over the collisions since the start of the run, r12 from the second "
         "centre to the first and dp the impulse on the first",
         unit::virial,
         {}},
        {"pressure",
         "Mean since the sample before: N T_tr and a third of what the virial gains in a unit of "
         "time, over the volume of the box; where there are walls, what all of them feel, over "
         "their area; NaN at the first sample, and with gravity along an axis with walls",
         unit::pressure,
         {}},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    const PressureSums sums = pressure_sums(now.totals.time, now.species.t_tr_integral,
                                            now.species.virial, now.species.walls);
    row.put(sums.virial);
    row.put(pressure_.between(before_, sums));
    before_ = sums;
  }

  bool reads_state() const override { return false; }

  void transfer(Archive& archive) override {
    auto& [time, t_tr_integral, virial, normal_impulse] = before_;
    archive(time, t_tr_integral, virial, normal_impulse);
    archive.require(std::isfinite(time) && std::isfinite(t_tr_integral) && std::isfinite(virial) &&
                    std::isfinite(normal_impulse));
  }

 private:
  Pressure pressure_;
  double packing_;
  PressureSums before_;  ///< at the sample before
};

}  // namespace

ObservablePointer make_rod_sums(const Scene& scene, const GasSetting& gas) {
  return std::make_unique<RodSums>(scene, gas);
}

}  // namespace needlework::observe
