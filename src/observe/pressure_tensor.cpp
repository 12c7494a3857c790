// The pressure tensor between two samples, by what flights have carried and collisions have handed
// over between them:
//
//   P_ab = (sum of m c_a c_b t over flights + sum of r12_a dp_b over collisions) / (V t)
//
// with velocities c beside the flow, and r12 between centres; V is the mean where walls with a
// velocity change it. It is that of the whole box, so that
// along axes with walls, whose force it does not know, it has no value.
#include <array>
#include <cmath>
#include <string_view>

#include "src/observe/described_fields.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

class PressureTensor : public Observable {
  // Errors are of the mean over a run.
  static bool is_taken(std::string_view name) { return !name.ends_with("_error"); }

 public:
  explicit PressureTensor(const GasSetting& gas)
      : gas_(gas), periodic_(gas.box.periodic()), rate_(gas.shear_rate) {}

  std::vector<SeriesField> fields() const override {
    return fields_of(StressTotals{}, {}, is_taken);
  }

  void sample(const Snapshot& now, Row& row) override {
    const StressSums& sums = now.species.stress;
    const double until = now.totals.time, volume = gas_.mean_volume(time_, until);
    const std::vector<StressTotals> since{
        StressTotals::between(before_, sums, until - time_, volume, periodic_, rate_)};
    put_numbers(row, since, is_taken);
    before_ = sums;
    time_ = now.totals.time;
  }

  bool reads_state() const override { return false; }

  void transfer(Archive& archive) override {
    archive(time_);
    archive.require(std::isfinite(time_));
    for (Tensor* tensor : {&before_.kinetic, &before_.collisional}) {
      for (auto& numbers : *tensor) {
        archive(numbers);
        for (const double number : numbers) archive.require(std::isfinite(number));
      }
    }
  }

 private:
  GasSetting gas_;
  std::array<bool, 3> periodic_;
  double rate_;
  double time_ = 0;    ///< of the sample before
  StressSums before_;  ///< at it
};

}  // namespace

ObservablePointer make_pressure_tensor(const GasSetting& gas) {
  return std::make_unique<PressureTensor>(gas);
}

}  // namespace needlework::observe
