#include "src/observe/cooling_theory.h"

#include "src/observe/forecast.h"

namespace needlework::observe {
namespace {

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
    const theory::Temperatures theory = curve_.at(time_scale_ * now.totals.time);
    row.put(theory.t_tr);
    row.put(theory.t_rot);
    row.put(theory.energy());
  }

  bool reads_state() const override { return false; }

  void transfer(Archive& archive) override {
    theory::CoolingCurve::Place place = curve_.place();
    archive(place);
    if (archive.reads()) curve_.go_to(place);
  }

 private:
  theory::CoolingCurve curve_;
  double time_scale_;
};

}  // namespace

ObservablePointer make_cooling_theory(const theory::Gas& gas, theory::Temperatures initial,
                                      double density) {
  return std::make_unique<CoolingTheory>(gas, initial, density);
}

}  // namespace needlework::observe
