// Pressure of rods between two samples, by pressure.h.
#include "src/observe/rod_sums.h"

#include <cmath>
#include <string_view>
#include <vector>

#include "src/observe/described_fields.h"
#include "src/observe/pressure.h"
#include "src/observe/rod_totals.h"

namespace needlework::observe {
namespace {

class RodSums : public Observable {
 public:
  explicit RodSums(const Scene& scene, const GasSetting& gas)
      : pressure_(scene), gas_(gas), grows_(scene.driving.growth.has_value()) {}

  std::vector<SeriesField> fields() const override {
    auto out = fields_of(RodTotals{});
    for (SeriesField& field : out) {
      if (field.name == "packing_fraction") {
        if (packing_varies()) continue;
        field.kind = SeriesField::Kind::constant;
        field.values = {packing_at(0)};
      } else if (field.name == "pressure") {
        field.meaning =
            "Mean since the sample before: N T_tr and a third of what the virial gains in a unit "
            "of time, over the volume of the box; where there are walls, what all of them feel, "
            "over their area; NaN at the first sample, and with gravity along an axis with walls";
      }
    }
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    const PressureSums sums = pressure_sums(now.totals.time, now.species.t_tr_integral,
                                            now.species.virial, now.species.walls);
    const std::vector<RodTotals> rods{
        {.packing_fraction = grows_ ? now.species.growth.packing_fraction : packing_at(sums.time),
         .virial = sums.virial,
         .pressure = pressure_.between(before_, sums)}};
    put_numbers(row, rods, [&](std::string_view name) {
      return packing_varies() || name != "packing_fraction";
    });
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
  double packing_at(double time) const {
    return gas_.composition.packing_fraction(gas_.volume_at(time));
  }

  bool packing_varies() const { return gas_.moving_edges || grows_; }

  Pressure pressure_;
  GasSetting gas_;
  bool grows_;
  PressureSums before_;  ///< at the sample before
};

}  // namespace

ObservablePointer make_rod_sums(const Scene& scene, const GasSetting& gas) {
  return std::make_unique<RodSums>(scene, gas);
}

}  // namespace needlework::observe
