// Statistics of the collisions since the sample before, as counts:
//
//   collisions       all of them
//   repeats          those of a pair that was also the last to collide for both of its needles
//   chains           finished chains by length. A chain is a sequence of collisions of one pair
//                    between which neither needle collides with another; it is finished when one
//                    does. Longer ones are in the last bin.
//   arms             s / L of both needles, each in its own length: where the contact lies
//   angle            angle between the directors, from 0 to pi; in equilibrium its density is
//                    (2 / pi) sin^2
//   normal_velocity  |V_n| in units of sigma, sigma^2 = 2 T_tr / m + T_rot (s12^2 + s21^2) / I with
//                    the temperatures of the sample before (for two species T_tr / m + T_rot s^2 /
//                    I of each; rods of finite width: times |u x n|^2, n along the impulse); in
//                    equilibrium its density is x exp(-x^2 / 2)
//
// With several species each is counted for each two of them; a collision with a needle of any
// species ends a chain. Values outside the borders are left out.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>
#include <utility>

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
double turning(const Species& species, double t_rot, double arm,
               const std::array<double, 3>& director, const std::array<double, 3>& impulse) {
  if (!species.turns()) return 0;
  const double square = t_rot * arm * arm / species.inertia();
  if (species.diameter == 0) return square;
  const double along = dot(director, impulse), size = dot(impulse, impulse);
  return size > 0 ? square * (1 - along * along / size) : square;
}

/// What is counted of the collisions of two species.
struct Counts {
  double collisions = 0, repeats = 0;
  std::vector<double> chains = std::vector<double>(longest_chain);
  Histogram arms{-0.5, 0.5, 50}, angle{0, std::numbers::pi, 45}, normal_velocity{0, 6, 60};

  void transfer(Archive& archive) {
    arms.transfer(archive);
    angle.transfer(archive);
    normal_velocity.transfer(archive);
    archive(collisions, repeats, chains);
    archive.require(chains.size() == longest_chain);
  }
};

class CollisionStatistics : public Observable {
 public:
  explicit CollisionStatistics(const GasSetting& gas)
      : gas_(gas), counts_(gas.composition.pairs()), last_(gas.composition.size()) {}

  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    const Counts& one = counts_.front();
    const auto borders = [](std::string name, const Histogram& of, const char* extent,
                            const char* unit) {
      return SeriesField{name + "_borders",
                         "Borders of the bins of " + name,
                         unit,
                         {{std::string(extent) + " + 1", of.counts().size() + 1}},
                         constant,
                         of.borders()};
    };
    const auto shape = [&](std::vector<SeriesField::Extent> values) {
      return by_pair(gas_.composition, std::move(values));
    };
    return {
        {"collisions", "Number of collisions since the sample before", unit::none, shape({}),
         count},
        {"repeats", "Number of these that repeat the last collision of both needles", unit::none,
         shape({}), count},
        {"chains",
         "Number of chains of collisions of one pair that ended since the sample before, by "
         "length from 1 on",
         unit::none, shape({{"chain lengths", longest_chain}}), count},
        {"arms",
         "Number of contacts by distance from the needle's centre along its orientation, in "
         "needle lengths",
         unit::none, shape({{"arm bins", one.arms.counts().size()}}), count},
        {"angle", "Number of collisions by angle between the orientations", unit::none,
         shape({{"angle bins", one.angle.counts().size()}}), count},
        {"normal_velocity",
         "Number of collisions by normal relative velocity of the contact points, in units of "
         "the thermal one of such points",
         unit::none, shape({{"normal velocity bins", one.normal_velocity.counts().size()}}), count},
        borders("arms", one.arms, "arm bins", unit::none),
        borders("angle", one.angle, "angle bins", unit::angle),
        borders("normal_velocity", one.normal_velocity, "normal velocity bins", unit::none),
    };
  }

  bool reads_state() const override { return false; }
  bool reads_collisions() const override { return true; }

  void collision(const Collision& c) override {
    const std::size_t a = gas_.species_by_id(c.first), b = gas_.species_by_id(c.second);
    const Species &first = gas_.composition[a], &second = gas_.composition[b];
    Counts& counts = counts_[gas_.composition.pair_index(a, b)];
    ++counts.collisions;
    follow_chains(c.first, c.second, counts);
    counts.arms.add(first.length > 0 ? c.arm_first / first.length : 0);
    counts.arms.add(second.length > 0 ? c.arm_second / second.length : 0);
    counts.angle.add(std::atan2(c.sin_angle, dot(c.after[0].orientation, c.after[1].orientation)));
    const double squares =
        last_[a].t_tr / first.mass + last_[b].t_tr / second.mass +
        turning(first, last_[a].t_rot, c.arm_first, c.after[0].orientation, c.impulse) +
        turning(second, last_[b].t_rot, c.arm_second, c.after[1].orientation, c.impulse);
    counts.normal_velocity.add(std::abs(c.normal_velocity) / std::sqrt(squares));
  }

  void sample(const Snapshot& now, Row& row) override {
    for (const Counts& each : counts_) row.put(each.collisions);
    for (const Counts& each : counts_) row.put(each.repeats);
    for (const Counts& each : counts_) row.put_all(each.chains);
    for (const Counts& each : counts_) row.put_all(each.arms.counts());
    for (const Counts& each : counts_) row.put_all(each.angle.counts());
    for (const Counts& each : counts_) row.put_all(each.normal_velocity.counts());
    counts_.assign(counts_.size(), {});
    for (std::size_t n = 0; n < last_.size(); ++n) {
      last_[n] = {now.species.totals[n].t_tr, now.species.totals[n].t_rot};
    }
  }

  void transfer(Archive& archive) override {
    for (Counts& each : counts_) each.transfer(archive);
    for (Temperatures& each : last_) archive(each.t_tr, each.t_rot);
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
  std::unordered_map<std::uint32_t, Chain> open_;
};

}  // namespace

ObservablePointer make_collision_statistics(const GasSetting& gas) {
  return std::make_unique<CollisionStatistics>(gas);
}

}  // namespace needlework::observe
