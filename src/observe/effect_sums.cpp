// Pressure on a wall of area A between two samples at t1 and t2, over all hits between them:
//
//   sum of J . n / (A (t2 - t1))
//
// A is the mean between them where walls with a velocity change it.
#include "src/observe/effect_sums.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "src/observe/described_fields.h"
#include "src/observe/mean_of_edges.h"
#include "src/scene/confinement.h"

namespace needlework::observe {
namespace {

class WallSums : public Observable {
  // Energies are in the budget, and pressures are those between two samples. Areas follow from the
  // box.
  struct Taken {
    bool shakes = false, travels = false, drags = false;

    bool operator()(std::string_view name) const {
      if (name == "phase") return shakes;
      if (name == "place") return travels;
      if (name == "work") return shakes || travels || drags;
      if (name.starts_with("impulse_")) return drags;
      return name != "normal_impulse" && name != "area" && name != "energy" && name != "pressure";
    }
  };

 public:
  explicit WallSums(const Scene& scene) : moving_edges_(moving_edges_of(scene, scene.needles.box)) {
    for (const Scene::WallSide& wall : scene.wall_sides()) {
      axes_.push_back(static_cast<double>(wall.axis));
      high_.push_back(wall.is_high);
      const Scene::Wall& given = scene.walls[wall.entry];
      taken_.drags |= given.temperature.has_value();
      if (!given.motion) continue;
      taken_.travels |= given.motion->velocity.has_value();
      taken_.shakes |= shakes(given);
    }
    impulse_before_.resize(axes_.size());
  }

  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    const std::vector<SeriesField::Extent> each{{"walls", axes_.size()}};
    std::vector<SeriesField> out = {
        {"axis", "Axis to which each wall is normal: 0 x, 1 y, 2 z", unit::none, each, constant,
         axes_},
        {"high", "1 for a wall at the high edge of the box, 0 at the low one", unit::none, each,
         constant, high_}};
    std::ranges::move(fields_of(WallTotals{}, each, taken_), std::back_inserter(out));
    out.push_back({"pressure",
                   "Sum of the impulses of hits since the sample before, along the normal of the "
                   "wall, divided by its area and by that time",
                   unit::pressure, each});
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    const std::vector<WallTotals>& walls = now.species.walls;
    put_numbers(row, walls, taken_);
    const double time = now.totals.time - before_;
    for (std::size_t n = 0; n < walls.size(); ++n) {
      const double impulse = walls[n].normal_impulse - impulse_before_[n];
      row.put(time > 0 ? impulse / (mean_area(walls[n], now.totals.time) * time)
                       : std::numeric_limits<double>::quiet_NaN());
      impulse_before_[n] = walls[n].normal_impulse;
    }
    before_ = now.totals.time;
  }

  bool reads_state() const override { return false; }

  void transfer(Archive& archive) override {
    archive(before_, impulse_before_);
    archive.require(
        std::isfinite(before_) && impulse_before_.size() == axes_.size() &&
        std::ranges::all_of(impulse_before_, [](double x) { return std::isfinite(x); }));
  }

 private:
  double mean_area(const WallTotals& wall, double until) const {
    const auto axis = static_cast<std::size_t>(wall.axis);
    const auto area = [&](const Vector& edges) {
      return edges[(axis + 1) % 3] * edges[(axis + 2) % 3];
    };
    return moving_edges_ ? mean_of_edges(*moving_edges_, before_, until, area) : wall.area;
  }

  std::vector<double> axes_, high_;
  std::optional<MovingEdges> moving_edges_;
  Taken taken_;
  double before_ = 0;  ///< time of the sample before
  std::vector<double> impulse_before_;
};

class BudgetOfEnergy : public Observable {
 public:
  explicit BudgetOfEnergy(const Scene& scene) {
    there_.walls.resize(scene.wall_sides().size());
    if (scene.driving.andersen) there_.thermostat = 0;
    if (scene.driving.kicks) there_.kicks = 0;
    if (has_gravity_along_periodic(scene)) there_.gravity = 0;
    if (scene.shear) there_.shear = 0;
    if (scene.driving.growth) there_.growth = there_.cooling = 0;
  }

  std::vector<SeriesField> fields() const override {
    return fields_of(there_, {}, EveryNumber{}, "walls");
  }

  void sample(const Snapshot& now, Row& row) override { put_numbers(row, now.species.energy); }

  bool reads_state() const override { return false; }

 private:
  EnergyBudget there_;  ///< with zeros for the effects that the scene has
};

class ContactSums : public Observable {
 public:
  std::vector<SeriesField> fields() const override { return fields_of(SlidingContacts{}); }
  void sample(const Snapshot& now, Row& row) override { put_numbers(row, now.species.contacts); }
  bool reads_state() const override { return false; }
};

class GrowthSums : public Observable {
 public:
  std::vector<SeriesField> fields() const override { return fields_of(GrowthTotals{}); }
  void sample(const Snapshot& now, Row& row) override { put_numbers(row, now.species.growth); }
  bool reads_state() const override { return false; }
};

}  // namespace

ObservablePointer make_growth_sums() { return std::make_unique<GrowthSums>(); }

ObservablePointer make_contact_sums() { return std::make_unique<ContactSums>(); }

ObservablePointer make_wall_sums(const Scene& scene) { return std::make_unique<WallSums>(scene); }

ObservablePointer make_energy_budget(const Scene& scene) {
  return std::make_unique<BudgetOfEnergy>(scene);
}

}  // namespace needlework::observe
