// Pressure of rods between two samples at t1 and t2, by the virial of all collisions between them:
//
//   p V = N T_tr + sum of r12 . dp / (3 (t2 - t1)),
//
// where N T_tr = (1/3) sum of m v^2 is the mean of those at both samples, r12 is from the second
// centre to the first and dp the impulse on the first.
#include "src/observe/rod_sums.h"

#include <cmath>
#include <limits>

namespace needlework::observe {
namespace {

class RodSums : public Observable {
 public:
  explicit RodSums(const GasSetting& gas)
      : count_(static_cast<double>(gas.composition.count())),
        volume_(gas.volume()),
        packing_(gas.composition.packing_fraction(gas.volume())) {}

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
         "N T_tr, the mean of this sample and the sample before, and a third of what the virial "
         "has gained between them, divided by that time, over the volume of the box; NaN at the "
         "first sample",
         unit::pressure,
         {}},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    const double virial = now.species.virial, kinetic = count_ * now.totals.t_tr;
    const double time = now.totals.time - time_before_;
    row.put(virial);
    row.put(time > 0
                ? (0.5 * (kinetic + kinetic_before_) + (virial - virial_before_) / (3 * time)) /
                      volume_
                : std::numeric_limits<double>::quiet_NaN());
    time_before_ = now.totals.time;
    virial_before_ = virial;
    kinetic_before_ = kinetic;
  }

  bool reads_state() const override { return false; }

  void transfer(Archive& archive) override {
    archive(time_before_, virial_before_, kinetic_before_);
    archive.require(std::isfinite(time_before_) && std::isfinite(virial_before_) &&
                    std::isfinite(kinetic_before_));
  }

 private:
  double count_, volume_, packing_;
  double time_before_ = 0, virial_before_ = 0, kinetic_before_ = 0;
};

}  // namespace

ObservablePointer make_rod_sums(const GasSetting& gas) { return std::make_unique<RodSums>(gas); }

}  // namespace needlework::observe
