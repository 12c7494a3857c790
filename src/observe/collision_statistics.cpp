// Statistics of the collisions since the sample before, as counts:
//
//   collisions       all of them
//   repeats          those of a pair that was also the last to collide for both of its needles
//   chains           finished chains by length. A chain is a sequence of collisions of one pair
//                    between which neither needle collides with another; it is finished when one
//                    does. Longer ones are in the last bin.
//   arms             s / L of both needles, each in its own length then: where the contact lies
//   angle            angle between the directors, from 0 to pi; in equilibrium its density is
//                    (2 / pi) sin^2
//   normal_velocity  |V_n| in units of sigma, sigma^2 = 2 T_tr / m + T_rot (s12^2 + s21^2) / I with
//                    the temperatures of the sample before (for two species T_tr / m + T_rot s^2 /
//                    I of each; rods of finite width: times |u x n|^2, n along the impulse); in
//                    equilibrium its density is x exp(-x^2 / 2)
//
// Lengths, masses and moments of inertia are those of the two needles, where they differ within a
// species. A fixed one has T = 0.
//
// With several species each is counted for each two of them; a collision with a needle of any
// species ends a chain. Values outside the borders are left out.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "needlework/described.h"
#include "src/observe/histogram.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

constexpr std::size_t longest_chain = 64;

/// The unfinished chain that a needle is in.
struct Chain {
  std::uint32_t partner = 0;
  std::size_t length = 0;  ///< 0: none
};

void transfer(Archive& archive, Chain& chain) { archive(chain.partner, chain.length); }

/// What the rotation of one of the bodies adds to the variance of V_n. Rods of finite width are not
/// normal to the impulse at their caps; spheres do not turn.
double turning(const BodyNumbers& body, double t_rot, double arm,
               const std::array<double, 3>& director, const std::array<double, 3>& impulse) {
  if (!(body.length > 0)) return 0;
  const double square = t_rot * arm * arm / body.inertia;
  if (body.diameter == 0) return square;
  const double along = dot(director, impulse), size = dot(impulse, impulse);
  return size > 0 ? square * (1 - along * along / size) : square;
}

/// What counts are by, where they are more than one: their extent, and the unit of borders.
struct Bins {
  const char* extent = "";
  const char* unit = unit::none;
};

std::span<const double> numbers_of(const double& count) { return {&count, 1}; }
std::span<const double> numbers_of(const std::vector<double>& counts) { return counts; }
std::span<const double> numbers_of(const Histogram& histogram) { return histogram.counts(); }

/// What is counted of the collisions of two species.
struct Counts {
  double collisions = 0, repeats = 0;
  std::vector<double> chains = std::vector<double>(longest_chain);
  Histogram arms{-0.5, 0.5, 50}, angle{0, std::numbers::pi, 45}, normal_velocity{0, 6, 60};

  /// Calls visit(Described, bins, value) for each: a number, numbers, or a histogram.
  template <class These, class Visit>
  static void for_each(These& these, const Visit& visit) {
    visit(Described{"collisions", unit::none, "Number of collisions since the sample before"},
          Bins{}, these.collisions);
    visit(Described{"repeats", unit::none,
                    "Number of these that repeat the last collision of both needles"},
          Bins{}, these.repeats);
    visit(Described{"chains", unit::none,
                    "Number of chains of collisions of one pair that ended since the sample "
                    "before, by length from 1 on"},
          Bins{"chain lengths"}, these.chains);
    visit(Described{"arms", unit::none,
                    "Number of contacts by distance from the needle's centre along its "
                    "orientation, in needle lengths"},
          Bins{"arm bins"}, these.arms);
    visit(Described{"angle", unit::none, "Number of collisions by angle between the orientations"},
          Bins{"angle bins", unit::angle}, these.angle);
    visit(Described{"normal_velocity", unit::none,
                    "Number of collisions by normal relative velocity of the contact points, in "
                    "units of the thermal one of such points"},
          Bins{"normal velocity bins"}, these.normal_velocity);
  }

  void transfer(Archive& archive) {
    for_each(*this, [&](const Described&, const Bins&, auto& value) {
      if constexpr (requires { value.transfer(archive); }) value.transfer(archive);
    });
    for_each(*this, [&](const Described&, const Bins&, auto& value) {
      if constexpr (!requires { value.transfer(archive); }) archive(value);
    });
    archive.require(chains.size() == longest_chain);
  }
};

class CollisionStatistics : public Observable {
 public:
  explicit CollisionStatistics(const GasSetting& gas)
      : gas_(gas), counts_(gas.composition.pairs()), last_(gas.composition.size()) {}

  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    std::vector<SeriesField> out, borders;
    Counts::for_each(counts_.front(), [&]<class Value>(const Described& number, const Bins& bins,
                                                       const Value& value) {
      std::vector<SeriesField::Extent> shape;
      if constexpr (!std::is_arithmetic_v<Value>)
        shape.push_back({bins.extent, numbers_of(value).size()});
      out.push_back({number.name, number.meaning, number.unit,
                     by_pair(gas_.composition, std::move(shape)), count});
      if constexpr (std::is_same_v<Value, Histogram>) {
        borders.push_back({std::string(number.name) + "_borders",
                           std::string("Borders of the bins of ") + number.name,
                           bins.unit,
                           {{std::string(bins.extent) + " + 1", value.counts().size() + 1}},
                           constant,
                           value.borders()});
      }
    });
    std::ranges::move(borders, std::back_inserter(out));
    return out;
  }

  bool reads_state() const override { return false; }
  bool reads_collisions() const override { return true; }

  void collision(const Collision& c) override {
    const std::size_t a = gas_.species_by_id(c.first), b = gas_.species_by_id(c.second);
    const BodyNumbers first = gas_.species_by_id.body(c.first, gas_.composition[a]);
    const BodyNumbers second = gas_.species_by_id.body(c.second, gas_.composition[b]);
    Counts& counts = counts_[gas_.composition.pair_index(a, b)];
    ++counts.collisions;
    follow_chains(c.first, c.second, counts);
    const double scale = scale_at(c.time);
    counts.arms.add(share_of(c.arm_first, first.length * scale));
    counts.arms.add(share_of(c.arm_second, second.length * scale));
    counts.angle.add(std::atan2(c.sin_angle, dot(c.after[0].orientation, c.after[1].orientation)));
    const double squares =
        last_[a].t_tr / first.mass + last_[b].t_tr / second.mass +
        turning(first, last_[a].t_rot, c.arm_first, c.after[0].orientation, c.impulse) +
        turning(second, last_[b].t_rot, c.arm_second, c.after[1].orientation, c.impulse);
    counts.normal_velocity.add(std::abs(c.normal_velocity) / std::sqrt(squares));
  }

  void sample(const Snapshot& now, Row& row) override {
    // All of the first name, then all of the second.
    std::vector<Row> by_name;
    for (const Counts& each : counts_) {
      std::size_t n = 0;
      Counts::for_each(each, [&](const Described&, const Bins&, const auto& value) {
        if (n == by_name.size()) by_name.emplace_back();
        by_name[n++].put_all(numbers_of(value));
      });
    }
    for (const Row& each : by_name) row.put_all(each.values());
    counts_.assign(counts_.size(), {});
    time_ = now.totals.time;
    sizes_ = now.species.growth;
    for (std::size_t n = 0; n < last_.size(); ++n) {
      last_[n] = {now.species.totals[n].t_tr, now.species.totals[n].t_rot};
    }
  }

  void transfer(Archive& archive) override {
    for (Counts& each : counts_) each.transfer(archive);
    for (Temperatures& each : last_) archive(each.t_tr, each.t_rot);
    if (gas_.grows) archive(time_, sizes_.scale, sizes_.rate);
    std::map<std::uint32_t, Chain> open(open_.begin(), open_.end());
    archive(open);
    open_ = {open.begin(), open.end()};
    archive.require(open_.size() <= gas_.count);
  }

 private:
  /// Of a species, at the sample before.
  struct Temperatures {
    double t_tr = 0, t_rot = 0;
  };

  double scale_at(double time) const {
    return gas_.grows ? sizes_.scale + sizes_.rate * (time - time_) : 1;
  }
  // Bodies that grow are as long as their caps are apart but for rounding.
  double share_of(double arm, double length) const {
    if (!(length > 0)) return 0;
    const double share = arm / length;
    return gas_.grows ? std::clamp(share, -0.5, 0.5) : share;
  }

  void follow_chains(std::uint32_t first, std::uint32_t second, Counts& counts) {
    const Chain& chain = open_[first];
    const std::size_t before = chain.length > 0 && chain.partner == second ? chain.length : 0;
    if (before > 0) {
      ++counts.repeats;
    } else {
      finish_chain_of(first);
      finish_chain_of(second);
    }
    open_[first] = {second, before + 1};
    open_[second] = {first, before + 1};
  }

  void finish_chain_of(std::uint32_t needle) {
    Chain& chain = open_[needle];
    if (chain.length == 0) return;
    const std::size_t pair =
        gas_.composition.pair_index(gas_.species_by_id(needle), gas_.species_by_id(chain.partner));
    ++counts_[pair].chains[std::min(chain.length, longest_chain) - 1];
    open_[chain.partner].length = 0;
    chain.length = 0;
  }

  GasSetting gas_;
  std::vector<Counts> counts_;      ///< by pair of species
  std::vector<Temperatures> last_;  ///< by species
  double time_ = 0;                 ///< of the sample before
  GrowthTotals sizes_;              ///< then
  std::unordered_map<std::uint32_t, Chain> open_;
};

}  // namespace

ObservablePointer make_collision_statistics(const GasSetting& gas) {
  return std::make_unique<CollisionStatistics>(gas);
}

}  // namespace needlework::observe
