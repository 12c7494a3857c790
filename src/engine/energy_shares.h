// How much each effect has changed the energy of all needles since the start of a run.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/double_double.h"
#include "src/engine/energy_account.h"
#include "src/engine/tally.h"

namespace needlework {

/// Shares in the changes that the account of the energy adds up. Within a window they are whole
/// numbers of quanta, which the tally has; at its end, as quanta change, they are added up as
/// energies, with twice the digits of a double. So they depend on no order of events, and their
/// sum differs from the change of the energy by what the account has drifted.
///
/// Collisions of two needles are what sources have not changed, so that they need no count.
class EnergyShares {
 public:
  /// To be called before the account is opened again for a new window.
  void settle(const EnergyAccount& account, const Tally& tally) {
    const auto add_window = [&](Share& share, const Quanta& quanta) {
      share.before = at(share, account, quanta);
      share.at_opening = quanta;
    };
    add_window(pairs_, of_pairs(tally));
    add_window(flow_, tally.flow);
    add_window(growth_, tally.growth);
    sources_.resize(tally.by_source.size());
    for (std::size_t n = 0; n < sources_.size(); ++n) {
      add_window(sources_[n], tally.by_source[n].energy);
    }
    objects_.resize(tally.by_object.size());
    for (std::size_t n = 0; n < objects_.size(); ++n) {
      add_window(objects_[n], tally.by_object[n].energy);
    }
  }
  /// Notes that all needles have been kicked, that a caller has replaced their velocities, or that
  /// they have been scaled back, and how their energy was before and after.
  void kicked(double before, double after) { kicks_ = kicks_ + two_sum(after, -before); }
  void velocities_set(double before, double after) { set_ = set_ + two_sum(after, -before); }
  void cooled(double before, double after) { cooling_ = cooling_ + two_sum(after, -before); }

  // Energies of all needles, as the account and the tally are now.
  double pairs(const EnergyAccount& account, const Tally& tally) const {
    return to_double(at(pairs_, account, of_pairs(tally)));
  }
  /// By uniform shear, in flights that are over and in collisions.
  double flow(const EnergyAccount& account, const Tally& tally) const {
    return to_double(at(flow_, account, tally.flow));
  }
  /// By growth, in collisions and at walls.
  double growth(const EnergyAccount& account, const Tally& tally) const {
    return to_double(at(growth_, account, tally.growth));
  }
  double source(std::size_t n, const EnergyAccount& account, const Tally& tally) const {
    return n < tally.by_source.size() ? now(sources_, n, account, tally.by_source[n].energy) : 0;
  }
  /// One of the objects of all sources.
  double object(std::size_t n, const EnergyAccount& account, const Tally& tally) const {
    return n < tally.by_object.size() ? now(objects_, n, account, tally.by_object[n].energy) : 0;
  }
  double kicks() const { return to_double(kicks_); }
  double velocities_set() const { return to_double(set_); }
  double cooling() const { return to_double(cooling_); }

  /// For a gas with so many sources and objects of them.
  template <class A>
  void transfer(A& archive, std::size_t sources, std::size_t objects, bool flows = false,
                bool grows = false) {
    pass(archive, pairs_);
    if (flows) pass(archive, flow_);
    if (grows) {
      pass(archive, growth_);
      pass(archive, cooling_);
    }
    for (DoubleDouble* each : {&kicks_, &set_}) pass(archive, *each);
    if (sources == 0) return;
    sources_.resize(sources);
    objects_.resize(objects);
    for (Share& share : sources_) pass(archive, share);
    for (Share& share : objects_) pass(archive, share);
  }

 private:
  struct Share {
    DoubleDouble before;  ///< this window
    Quanta at_opening;    ///< at its start
  };

  static Quanta of_pairs(const Tally& tally) {
    Quanta quanta = tally.energy - tally.flow - tally.growth;
    for (const SourceTally& source : tally.by_source) quanta -= source.energy;
    return quanta;
  }
  static DoubleDouble at(const Share& share, const EnergyAccount& account, const Quanta& quanta) {
    return share.before + account.of_quanta(quanta - share.at_opening);
  }
  // Shares are as many as the tally had entries at the last settlement.
  static double now(const std::vector<Share>& shares, std::size_t n, const EnergyAccount& account,
                    const Quanta& quanta) {
    return to_double(at(n < shares.size() ? shares[n] : Share{}, account, quanta));
  }
  template <class A>
  static void pass(A& archive, DoubleDouble& sum) {
    archive(sum.hi, sum.lo);
    archive.require(std::isfinite(sum.hi) && std::isfinite(sum.lo));
  }
  template <class A>
  static void pass(A& archive, Share& share) {
    pass(archive, share.before);
    archive(share.at_opening);
  }

  Share pairs_, flow_, growth_;
  std::vector<Share> sources_, objects_;
  DoubleDouble kicks_, set_, cooling_;
};

}  // namespace needlework
