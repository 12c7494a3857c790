#include "src/observe/cooling_theory.h"

#include <limits>
#include <memory>

#include "src/observe/forecast.h"

namespace needlework::observe {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

std::vector<SeriesField> fields_of_all() {
  return {
      {"t_tr", "Translational temperature by kinetic theory", unit::energy},
      {"t_rot", "Rotational temperature by kinetic theory", unit::energy},
      {"energy", "Kinetic energy per needle by kinetic theory", unit::energy},
  };
}

void put_all(Row& row, const theory::Temperatures& all) {
  row.put(all.t_tr);
  row.put(all.t_rot);
  row.put(all.energy());
}

class CoolingTheory : public Observable {
 public:
  CoolingTheory(const theory::Gas& gas, theory::Temperatures initial, double density)
      : curve_(gas, initial), time_scale_(theory_time_scale(density)) {}

  std::vector<SeriesField> fields() const override { return fields_of_all(); }

  void sample(const Snapshot& now, Row& row) override {
    put_all(row, holds_ ? curve_.at(time_scale_ * now.totals.time)
                        : theory::Temperatures{undefined, undefined});
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

class MixtureTheory : public Observable {
 public:
  MixtureTheory(const Composition& composition, double volume,
                const std::vector<theory::Temperatures>& initial)
      : curve_(composition, volume, initial), composition_(composition) {}

  std::vector<SeriesField> fields() const override {
    std::vector<SeriesField> out = fields_of_all();
    const std::vector<SeriesField::Extent> each{{"species", composition_.size()}};
    out.push_back({"species_t_tr", "Translational temperature of each species by kinetic theory",
                   unit::energy, each});
    out.push_back({"species_t_rot", "Rotational temperature of each species by kinetic theory",
                   unit::energy, each});
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    std::vector<theory::Temperatures> theory(composition_.size(), {undefined, undefined});
    if (holds_) theory = curve_.at(now.totals.time);
    put_all(row, theory::mean_of_species(composition_, theory));
    for (const theory::Temperatures& each : theory) row.put(each.t_tr);
    for (const theory::Temperatures& each : theory) row.put(each.t_rot);
  }

  bool reads_state() const override { return false; }
  void velocities_set() override { holds_ = false; }

  void transfer(Archive& archive) override {
    std::vector<double> place = curve_.place();
    archive(place, holds_);
    if (archive.reads()) curve_.go_to(place);
  }

 private:
  theory::MixtureCurve curve_;
  Composition composition_;
  bool holds_ = true;
};

}  // namespace

ObservablePointer make_cooling_theory(const theory::Gas& gas, theory::Temperatures initial,
                                      double density) {
  return std::make_unique<CoolingTheory>(gas, initial, density);
}

ObservablePointer make_mixture_theory(const Composition& composition, double volume,
                                      const std::vector<theory::Temperatures>& initial) {
  return std::make_unique<MixtureTheory>(composition, volume, initial);
}

}  // namespace needlework::observe
