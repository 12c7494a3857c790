#include "src/observe/cooling_theory.h"

#include <array>
#include <limits>

#include "src/observe/forecast.h"

namespace needlework::observe {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

class CoolingTheory : public Observable {
 public:
  CoolingTheory(const theory::Gas& gas, theory::Temperatures initial, double density)
      : curve_(gas, initial), time_scale_(theory_time_scale(density)) {}

  std::vector<SeriesField> fields() const override {
    return {
        {"t_tr", "Translational temperature by kinetic theory", unit::energy},
        {"t_rot", "Rotational temperature by kinetic theory", unit::energy},
        {"energy", "Kinetic energy per needle by kinetic theory", unit::energy},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    if (!holds_) {
      row.put_all(std::array<double, 3>{undefined, undefined, undefined});
      return;
    }
    const theory::Temperatures theory = curve_.at(time_scale_ * now.totals.time);
    row.put(theory.t_tr);
    row.put(theory.t_rot);
    row.put(theory.energy());
  }

  bool reads_state() const override { return false; }
  void velocities_set() override { holds_ = false; }

  void transfer(Archive& archive) override {
    theory::CoolingCurve::Place place = curve_.place();
    archive(place, holds_);
    if (archive.reads()) curve_.go_to(place);
  }

 private:
  theory::CoolingCurve curve_;
  double time_scale_;
  bool holds_ = true;  ///< as long as the gas is left to itself
};

}  // namespace

ObservablePointer make_cooling_theory(const theory::Gas& gas, theory::Temperatures initial,
                                      double density) {
  return std::make_unique<CoolingTheory>(gas, initial, density);
}

}  // namespace needlework::observe
