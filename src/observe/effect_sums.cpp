// Pressure on a wall of area A between two samples at t1 and t2, over all hits between them:
//
//   sum of J . n / (A (t2 - t1))
#include "src/observe/effect_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/observe/contact_share.h"
#include "src/scene/confinement.h"

namespace needlework::observe {
namespace {

class WallSums : public Observable {
 public:
  explicit WallSums(const Scene& scene) {
    for (const Scene::WallSide& wall : scene.wall_sides()) {
      axes_.push_back(static_cast<double>(wall.axis));
      high_.push_back(wall.is_high);
      has_motion_ |= scene.walls[wall.entry].motion.has_value();
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
         constant, high_},
        {"hits",
         "Number of hits on each wall since the start of the run, in the order of the scene, where "
         "both counts as low, then high",
         unit::none, each, count},
        {"impulse", "Sum of the magnitudes of the impulses of these hits", unit::momentum, each},
        {"pressure",
         "Sum of the impulses of hits since the sample before, along the normal of the wall, "
         "divided by its area and by that time",
         unit::pressure, each},
    };
    if (has_motion_) {
      out.push_back({"phase",
                     "Phase of the motion of each wall, from 0 to 2 pi, so that its surface is off "
                     "by amplitude times its sine; NaN for walls at rest",
                     unit::angle, each});
    }
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    const std::vector<WallTotals>& walls = now.species.walls;
    for (const WallTotals& each : walls) row.put(static_cast<double>(each.hits));
    for (const WallTotals& each : walls) row.put(each.impulse);
    const double time = now.totals.time - before_;
    for (std::size_t n = 0; n < walls.size(); ++n) {
      const double impulse = walls[n].normal_impulse - impulse_before_[n];
      row.put(time > 0 ? impulse / (walls[n].area * time)
                       : std::numeric_limits<double>::quiet_NaN());
      impulse_before_[n] = walls[n].normal_impulse;
    }
    before_ = now.totals.time;
    if (!has_motion_) return;
    for (const WallTotals& each : walls) row.put(each.phase);
  }

  bool reads_state() const override { return false; }

  void transfer(Archive& archive) override {
    archive(before_, impulse_before_);
    archive.require(
        std::isfinite(before_) && impulse_before_.size() == axes_.size() &&
        std::ranges::all_of(impulse_before_, [](double x) { return std::isfinite(x); }));
  }

 private:
  std::vector<double> axes_, high_;
  bool has_motion_ = false;
  double before_ = 0;  ///< time of the sample before
  std::vector<double> impulse_before_;
};

class BudgetOfEnergy : public Observable {
 public:
  explicit BudgetOfEnergy(const Scene& scene)
      : walls_(scene.wall_sides().size()),
        has_thermostat_(scene.driving.andersen),
        has_kicks_(scene.driving.kicks),
        is_pulled_(has_gravity_along_periodic(scene)) {}

  std::vector<SeriesField> fields() const override {
    const std::string since = " since the start of the run; negative: taken out";
    std::vector<SeriesField> out = {
        {"pairs",
         "Energy per needle that collisions of two needles have put in" + since,
         unit::energy,
         {}}};
    if (walls_ > 0) {
      out.push_back({"walls",
                     "Energy per needle that hits on each wall have put in" + since,
                     unit::energy,
                     {{"walls", walls_}}});
    }
    if (has_thermostat_) {
      out.push_back({"thermostat",
                     "Energy per needle that the thermostat has put in" + since,
                     unit::energy,
                     {}});
    }
    if (has_kicks_) {
      out.push_back(
          {"kicks", "Energy per needle that kicks have put in" + since, unit::energy, {}});
    }
    if (is_pulled_) {
      out.push_back({"gravity",
                     "Energy per needle that gravity along periodic axes has put in" + since,
                     unit::energy,
                     {}});
    }
    out.push_back({"velocities_set",
                   "Energy per needle that velocities set by a caller have put in" + since,
                   unit::energy,
                   {}});
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    now.species.energy.for_each([&](const char*, const auto& energy) {
      if constexpr (std::is_arithmetic_v<std::decay_t<decltype(energy)>>) {
        row.put(energy);
      } else {
        row.put_all(energy);
      }
    });
  }

  bool reads_state() const override { return false; }

 private:
  std::size_t walls_;
  bool has_thermostat_, has_kicks_, is_pulled_;
};

class ContactSums : public Observable {
 public:
  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    const auto number = [](const char* name, const char* meaning) {
      return SeriesField{name, meaning, unit::none, {}, count};
    };
    return {
        number("entered", "Number of contacts that have begun since the start of the run"),
        number("ended_by_force", "Number of them that have ended where the force would pull"),
        number("ended_by_tip", "Number of them that have ended as a tip was reached"),
        number("ended_by_strike",
               "Number of them that have ended as anything else changed the velocities of one of "
               "the needles"),
        number("crowded",
               "Number of collisions whose epsilon was raised, as one of the needles had just "
               "touched another one or a wall"),
        {"time",
         "Time that pairs have been in contact, of all together, without that of present steps",
         unit::time,
         {}},
        {"share",
         "Share of its time since the start of the run that a needle has been in contact, the mean "
         "of all: 2 time / (N t); NaN at the start",
         unit::none,
         {}},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    const SlidingContacts& contacts = now.species.contacts;
    for (const std::uint64_t number :
         {contacts.entered, contacts.ended_by_force, contacts.ended_by_tip,
          contacts.ended_by_strike, contacts.crowded}) {
      row.put(static_cast<double>(number));
    }
    row.put(contacts.time);
    row.put(contact_share(contacts.time, now.gas.count, now.totals.time));
  }

  bool reads_state() const override { return false; }
};

}  // namespace

ObservablePointer make_contact_sums() { return std::make_unique<ContactSums>(); }

ObservablePointer make_wall_sums(const Scene& scene) { return std::make_unique<WallSums>(scene); }

ObservablePointer make_energy_budget(const Scene& scene) {
  return std::make_unique<BudgetOfEnergy>(scene);
}

}  // namespace needlework::observe
