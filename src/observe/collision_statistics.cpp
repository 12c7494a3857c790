// Statistics of the collisions since the sample before, as counts:
//
//   collisions       all of them
//   repeats          those of a pair that was also the last to collide for both of its needles
//   chains           finished chains by length. A chain is a sequence of collisions of one pair
//                    between which neither needle collides with another; it is finished when one
//                    does. Longer ones are in the last bin.
//   arms             s / L of both needles: where the contact lies along the needle
//   angle            angle between the directors, from 0 to pi; in equilibrium its density is
//                    (2 / pi) sin^2
//   normal_velocity  |V_n| in units of sigma, sigma^2 = 2 T_tr / m + T_rot (s12^2 + s21^2) / I with
//                    the temperatures of the sample before; in equilibrium its density is
//                    x exp(-x^2 / 2)
//
// Values outside the borders are left out.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>

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

class CollisionStatistics : public Observable {
 public:
  explicit CollisionStatistics(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    const auto borders = [](std::string name, const Histogram& of, const char* extent,
                            const char* unit) {
      return SeriesField{name + "_borders",
                         "Borders of the bins of " + name,
                         unit,
                         {{std::string(extent) + " + 1", of.counts().size() + 1}},
                         constant,
                         of.borders()};
    };
    return {
        {"collisions", "Number of collisions since the sample before", unit::none, {}, count},
        {"repeats",
         "Number of these that repeat the last collision of both needles",
         unit::none,
         {},
         count},
        {"chains",
         "Number of chains of collisions of one pair that ended since the sample before, by "
         "length from 1 on",
         unit::none,
         {{"chain lengths", longest_chain}},
         count},
        {"arms",
         "Number of contacts by distance from the needle's centre along its orientation, in "
         "needle lengths",
         unit::none,
         {{"arm bins", arms_.counts().size()}},
         count},
        {"angle",
         "Number of collisions by angle between the orientations",
         unit::none,
         {{"angle bins", angle_.counts().size()}},
         count},
        {"normal_velocity",
         "Number of collisions by normal relative velocity of the contact points, in units of "
         "the thermal one of such points",
         unit::none,
         {{"normal velocity bins", normal_velocity_.counts().size()}},
         count},
        borders("arms", arms_, "arm bins", unit::none),
        borders("angle", angle_, "angle bins", unit::angle),
        borders("normal_velocity", normal_velocity_, "normal velocity bins", unit::none),
    };
  }

  bool reads_state() const override { return false; }
  bool reads_collisions() const override { return true; }

  void collision(const Collision& c) override {
    ++collisions_;
    follow_chains(c.first, c.second);
    arms_.add(c.arm_first / gas_.length);
    arms_.add(c.arm_second / gas_.length);
    angle_.add(std::atan2(c.sin_angle, dot(c.after[0].orientation, c.after[1].orientation)));
    const double squares = c.arm_first * c.arm_first + c.arm_second * c.arm_second;
    const double sigma = std::sqrt(2 * t_tr_ / gas_.mass + t_rot_ * squares / gas_.inertia);
    normal_velocity_.add(std::abs(c.normal_velocity) / sigma);
  }

  void sample(const Snapshot& now, Row& row) override {
    row.put(collisions_);
    row.put(repeats_);
    row.put_all(chains_);
    row.put_all(arms_.counts());
    row.put_all(angle_.counts());
    row.put_all(normal_velocity_.counts());
    collisions_ = repeats_ = 0;
    chains_.assign(longest_chain, 0.0);
    arms_.clear();
    angle_.clear();
    normal_velocity_.clear();
    t_tr_ = now.totals.t_tr;
    t_rot_ = now.totals.t_rot;
  }

  void transfer(Archive& archive) override {
    arms_.transfer(archive);
    angle_.transfer(archive);
    normal_velocity_.transfer(archive);
    std::map<std::uint32_t, Chain> open(open_.begin(), open_.end());
    archive(collisions_, repeats_, t_tr_, t_rot_, chains_, open);
    open_ = {open.begin(), open.end()};
    archive.require(chains_.size() == longest_chain && open_.size() <= gas_.count);
  }

 private:
  void follow_chains(std::uint32_t first, std::uint32_t second) {
    const Chain& chain = open_[first];
    const std::size_t before = chain.length > 0 && chain.partner == second ? chain.length : 0;
    if (before > 0) {
      ++repeats_;
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
    ++chains_[std::min(chain.length, longest_chain) - 1];
    open_[chain.partner].length = 0;
    chain.length = 0;
  }

  GasSetting gas_;
  double collisions_ = 0, repeats_ = 0;
  double t_tr_ = 0, t_rot_ = 0;
  std::vector<double> chains_ = std::vector<double>(longest_chain);
  Histogram arms_{-0.5, 0.5, 50}, angle_{0, std::numbers::pi, 45}, normal_velocity_{0, 6, 60};
  std::unordered_map<std::uint32_t, Chain> open_;
};

}  // namespace

ObservablePointer make_collision_statistics(const GasSetting& gas) {
  return std::make_unique<CollisionStatistics>(gas);
}

}  // namespace needlework::observe
